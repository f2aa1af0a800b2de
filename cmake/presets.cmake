# Writes build/.../presets.cpp: the files config/*.toml as strings in the program, so that it needs no
# files beside it.
function(fovea_embed_presets target)
  file(GLOB presets CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/config/*.toml)
  set(entries "")
  foreach(preset ${presets})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${preset})
    get_filename_component(name ${preset} NAME_WE)
    file(READ ${preset} text)
    string(APPEND entries "    {\"${name}\", R\"toml(${text})toml\"},\n")
  endforeach()
  set(output ${PROJECT_BINARY_DIR}/generated/presets.cpp)
  file(CONFIGURE OUTPUT ${output} CONTENT "#include \"fovea/pipeline/presets.h\"

namespace fovea {
namespace {
constexpr Preset kEmbedded[] = {
@entries@};
}
const std::span<const Preset> kPresets = kEmbedded;
}  // namespace fovea
" @ONLY)
  target_sources(${target} PRIVATE ${output})
endfunction()
