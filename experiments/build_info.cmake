# Writes build_info.hpp: version, commit, compiler and flags of this build. Run at every build, it
# touches the file only when something changed. Arguments: SOURCE, OUTPUT, VERSION, COMPILER, FLAGS.
execute_process(COMMAND git -C ${SOURCE} rev-parse HEAD OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no
  OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(dirty false)
if(changes)
  set(dirty true)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#pragma once
namespace driftless::build_info {
inline constexpr char version[] = \"${VERSION}\";
inline constexpr char commit[] = \"${commit}\";
inline constexpr bool dirty = ${dirty};
inline constexpr char compiler[] = \"${COMPILER}\";
inline constexpr char flags[] = \"${FLAGS}\";
}  // namespace driftless::build_info
")
