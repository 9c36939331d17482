# The bench and the naive reference that it measures against, which keeps the compiler's plain -O2
# whatever the rest is built with. Included from the folder above, after driftless_experiments
# exists.
file(GLOB bench_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
target_sources(driftless_experiments PRIVATE ${bench_sources})
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/naive.cpp PROPERTIES COMPILE_OPTIONS -O2)
