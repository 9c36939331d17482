# `driftless compare`. Included from the folder above, after driftless_experiments exists.
file(GLOB COMPARE_SOURCES CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.cpp)
target_sources(driftless_experiments PRIVATE ${COMPARE_SOURCES})
