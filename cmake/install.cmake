# cmake --install: the program, every build of the library, its headers, and the package by which
# find_package(driftless) gives driftless::driftless. Methods are compiled against it from outside.
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/driftless)
file(RELATIVE_PATH from_program ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
# Where the program looks for the library, built or installed. One path for both: for another one at
# install time CMake would leave room behind a colon, and what is behind it is the working directory.
set_target_properties(driftless PROPERTIES BUILD_WITH_INSTALL_RPATH ON
  INSTALL_RPATH "$ORIGIN/lib;$ORIGIN/${from_program}")

install(TARGETS driftless)
install(TARGETS driftless_library EXPORT driftless)
foreach(level ${DRIFTLESS_CPU_LEVELS})
  install(TARGETS driftless_library_${level}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${level} NAMELINK_SKIP)
endforeach()
install(DIRECTORY model integrators DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/driftless
  FILES_MATCHING PATTERN *.hpp)

install(EXPORT driftless NAMESPACE driftless:: FILE driftlessTargets.cmake
  DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/driftlessConfig.cmake.in
  ${PROJECT_BINARY_DIR}/driftlessConfig.cmake INSTALL_DESTINATION ${package_folder}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/driftlessConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/driftlessConfig.cmake
  ${PROJECT_BINARY_DIR}/driftlessConfigVersion.cmake DESTINATION ${package_folder})
