# driftless_library: the shared library libdriftless.so that model/ and integrators/ fill with
# sources. Where the loader can choose (x86-64, glibc 2.33 or later) it is built once more for each
# level in DRIFTLESS_CPU_LEVELS, into a folder from which glibc takes the best that the processor
# has: lib/glibc-hwcaps/<level>/. Only the library depends on the processor; all else is baseline.
include(CheckCXXSourceCompiles)

# GCC 11 and clang 12 know the levels.
set(CMAKE_REQUIRED_FLAGS -march=x86-64-v4)
check_cxx_source_compiles("
#include <features.h>
#if !defined(__x86_64__) || defined(__ILP32__) || !__GLIBC_PREREQ(2, 33)
#error the loader does not choose
#endif
int main() {}" DRIFTLESS_LOADER_CHOOSES)
unset(CMAKE_REQUIRED_FLAGS)
if(DRIFTLESS_LOADER_CHOOSES)
  set(loader_chooses ON)
else()
  set(loader_chooses OFF)
endif()
option(DRIFTLESS_CPU_VARIANTS "Build the library for several x86-64 levels; the loader chooses"
  ${loader_chooses})

set(DRIFTLESS_LIBRARY_FLAGS -fno-math-errno -fno-trapping-math)
if(DRIFTLESS_SANITIZE)
  list(APPEND DRIFTLESS_LIBRARY_FLAGS -O1)  # what takes the time in tests; the rest builds faster
endif()
set(DRIFTLESS_LIBRARY_FOLDER ${PROJECT_BINARY_DIR}/lib)
set(DRIFTLESS_CPU_LEVELS "")
if(DRIFTLESS_CPU_VARIANTS)
  set(DRIFTLESS_CPU_LEVELS x86-64-v3 x86-64-v4)
endif()

function(driftless_add_library target folder)
  add_library(${target} SHARED)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME driftless EXPORT_NAME driftless
    LIBRARY_OUTPUT_DIRECTORY ${folder} VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/driftless>)
  target_include_directories(${target} SYSTEM PUBLIC $<BUILD_INTERFACE:${RANDOM123_INCLUDE_DIR}>)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen hwy::hwy
    PRIVATE Boost::headers TBB::tbb ${CMAKE_DL_LIBS})
  # What crosses the border of the library must not depend on the processor: the alignment of
  # Eigen's memory would. Highway asks for two instruction sets more than x86-64-v3 and -v4 promise,
  # and Highway 1.0 refuses processors that have even more.
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16 HWY_DISABLE_PCLMUL_AES
    HWY_DISABLED_TARGETS=HWY_AVX3_DL)
  # Programs and modules instantiate the same templates for other instructions. Each keeps to its
  # own, and so does the library.
  target_compile_options(${target} PRIVATE ${DRIFTLESS_LIBRARY_FLAGS} -fvisibility-inlines-hidden
    -fno-semantic-interposition)
  target_link_options(${target} PRIVATE LINKER:-Bsymbolic-functions INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,MODULE_LIBRARY>:LINKER:-Bsymbolic-functions>)
endfunction()

driftless_add_library(driftless_library ${DRIFTLESS_LIBRARY_FOLDER})
add_library(driftless::driftless ALIAS driftless_library)
set(DRIFTLESS_LIBRARIES driftless_library)  # every build of it
if(DRIFTLESS_CPU_VARIANTS)
  target_compile_options(driftless_library PRIVATE -march=x86-64-v2)
endif()
foreach(level ${DRIFTLESS_CPU_LEVELS})
  set(variant driftless_library_${level})
  driftless_add_library(${variant} ${DRIFTLESS_LIBRARY_FOLDER}/glibc-hwcaps/${level})
  target_compile_options(${variant} PRIVATE -march=${level})
  # Halves what the variants add to the time of a build. The first one is compiled without, so that
  # files still include what they use.
  target_precompile_headers(${variant} PRIVATE model/system.hpp)
  target_compile_options(${variant} PRIVATE ${DRIFTLESS_PRECOMPILED_FALSE_ALARMS})
  add_dependencies(driftless_library ${variant})  # whoever links one can be given the other
  list(APPEND DRIFTLESS_LIBRARIES ${variant})
endforeach()

# driftless_sources(FILES...): adds them to every build of the library.
function(driftless_sources)
  foreach(library ${DRIFTLESS_LIBRARIES})
    target_sources(${library} PRIVATE ${ARGN})
  endforeach()
endfunction()
