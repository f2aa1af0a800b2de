# Writes build/.../html_report_assets.cpp: the report page's files as strings in the program.
function(fovea_embed_html_report target)
  set(folder ${PROJECT_SOURCE_DIR}/app/html_report)
  set(definitions "")
  foreach(name Html Css Js)
    string(TOLOWER ${name} ending)
    set(file ${folder}/page.${ending})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} text)
    string(APPEND definitions "const std::string_view kPage${name} = R\"asset(${text})asset\";\n")
  endforeach()
  set(output ${PROJECT_BINARY_DIR}/generated/html_report_assets.cpp)
  file(CONFIGURE OUTPUT ${output} CONTENT "#include \"app/html_report/assets.h\"

namespace fovea::app {
@definitions@}  // namespace fovea::app
" @ONLY)
  target_sources(${target} PRIVATE ${output})
endfunction()
