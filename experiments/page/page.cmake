# Bundles the pages' templates. After include(page/page.cmake) in experiments/CMakeLists.txt the variable
# DRIFTLESS_PAGE_TEMPLATE names the generated source that experiments/page.cpp needs beside it.
find_program(NODE_EXECUTABLE NAMES node nodejs REQUIRED)
set(page_folder "${PROJECT_SOURCE_DIR}/experiments/page")
set(page_modules "${PROJECT_SOURCE_DIR}/node_modules/.package-lock.json")
if(NOT EXISTS "${page_modules}")
  message(FATAL_ERROR "The page's chart libraries are missing: run `npm ci --omit=dev` in ${PROJECT_SOURCE_DIR}")
endif()

file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS "${page_folder}/*.js" "${page_folder}/*.css" "${page_folder}/*.html")
set(page_output "${CMAKE_CURRENT_BINARY_DIR}/page")
set(DRIFTLESS_PAGE_TEMPLATE "${page_output}/page_template.cpp")
add_custom_command(
  OUTPUT "${DRIFTLESS_PAGE_TEMPLATE}" "${page_output}/result.html" "${page_output}/judgement.html"
    "${page_output}/papers.html"
  COMMAND "${NODE_EXECUTABLE}" "${page_folder}/bundle.mjs" "${page_output}"
  DEPENDS ${page_sources} "${page_folder}/bundle.mjs" "${PROJECT_SOURCE_DIR}/package.json" "${page_modules}"
  COMMENT "Bundling the pages"
  VERBATIM)
