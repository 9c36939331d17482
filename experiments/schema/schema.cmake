# Puts result.schema.json into the library. Included from the folder above, after
# driftless_experiments exists.
set(schema_file ${CMAKE_CURRENT_LIST_DIR}/result.schema.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${schema_file})
file(READ ${schema_file} RESULT_SCHEMA)
set(schema_source ${CMAKE_CURRENT_BINARY_DIR}/result_schema_text.cpp)
configure_file(${CMAKE_CURRENT_LIST_DIR}/result_schema_text.cpp.in ${schema_source} @ONLY)
target_sources(driftless_experiments PRIVATE ${schema_source})
