# Builds the viewer's page (viewer/, by npm) and puts its files into a target of the program.
find_program(FOVEA_NPM npm REQUIRED)

function(fovea_embed_viewer target)
  set(folder ${PROJECT_SOURCE_DIR}/viewer)
  if(NOT IS_DIRECTORY ${folder}/node_modules)
    message(FATAL_ERROR "npm's packages of viewer/ are missing: install them with scripts/setup.sh")
  endif()
  set(output ${PROJECT_BINARY_DIR}/viewer_page)
  set(files ${output}/index.html ${output}/assets/page.js ${output}/assets/page.css)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/src/*)
  list(FILTER sources EXCLUDE REGEX "\\.test\\.ts$")
  add_custom_command(
    OUTPUT ${files}
    COMMAND ${FOVEA_NPM} run --silent build -- --outDir ${output} --emptyOutDir --logLevel warn
    WORKING_DIRECTORY ${folder}
    DEPENDS ${sources} ${folder}/index.html ${folder}/package-lock.json ${folder}/tsconfig.json
            ${folder}/vite.config.js
    COMMENT "Building the viewer's page (after scripts/setup.sh)"
    VERBATIM)
  set(FOVEA_VIEWER_PAGE ${output})
  set(generated ${PROJECT_BINARY_DIR}/generated/viewer_page.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/viewer_page.cpp.in ${generated} @ONLY)
  set_source_files_properties(${generated} PROPERTIES OBJECT_DEPENDS "${files}"
                              SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${generated})
endfunction()
