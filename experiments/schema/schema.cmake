# Puts the schemas of the files that the program writes into the library. Included from the folder above, after
# driftless_experiments exists.
foreach(kind result comparison judgement papers)
  set(schema_file ${CMAKE_CURRENT_LIST_DIR}/${kind}.schema.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${schema_file})
  file(READ ${schema_file} SCHEMA)
  set(schema_source ${CMAKE_CURRENT_BINARY_DIR}/${kind}_schema_text.cpp)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/schema_text.cpp.in ${schema_source} @ONLY)
  target_sources(driftless_experiments PRIVATE ${schema_source})
endforeach()
