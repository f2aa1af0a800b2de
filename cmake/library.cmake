# The shared library with the public C++ API (include/fovea): all parts in one file, of which only that API is visible.
get_property(modules GLOBAL PROPERTY FOVEA_MODULES)
file(GLOB api_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/fovea/*.h)
# The objects themselves: functions of the API lie in archives that nothing else may need. The archives bring the
# libraries that they link.
add_library(fovea_shared SHARED)
foreach(module IN LISTS modules)
  target_sources(fovea_shared PRIVATE $<TARGET_OBJECTS:${module}>)
endforeach()
set_target_properties(fovea_shared PROPERTIES LINKER_LANGUAGE CXX)
add_library(fovea::fovea ALIAS fovea_shared)
# Programs of other versions look for another file (docs/compatibility.md).
set_target_properties(fovea_shared PROPERTIES OUTPUT_NAME fovea EXPORT_NAME fovea VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_include_directories(fovea_shared PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                               $<INSTALL_INTERFACE:include>)
target_link_libraries(fovea_shared PUBLIC Eigen3::Eigen PRIVATE ${modules})
target_link_options(fovea_shared PRIVATE LINKER:--no-undefined)
target_compile_definitions(fovea_shared PUBLIC ${FOVEA_EIGEN_ALIGNMENT})
target_compile_features(fovea_shared PUBLIC cxx_std_20)
