# Every library the product links: permissive licences only, all from Debian's packages
# (scripts/packages.txt lists them).
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(pugixml REQUIRED)
find_package(PkgConfig REQUIRED)

if(NOT TARGET nanoflann::nanoflann)
  find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp REQUIRED)
  add_library(nanoflann::nanoflann INTERFACE IMPORTED)
  target_include_directories(nanoflann::nanoflann INTERFACE ${NANOFLANN_INCLUDE_DIR})
endif()

# Libraries that Debian ships without (usable) CMake files.
function(fovea_import target header library)
  string(MAKE_C_IDENTIFIER ${target} id)
  find_path(${id}_INCLUDE_DIR ${header} REQUIRED)
  find_library(${id}_LIBRARY ${library} REQUIRED)
  add_library(${target} UNKNOWN IMPORTED)
  set_target_properties(${target} PROPERTIES IMPORTED_LOCATION ${${id}_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${${id}_INCLUDE_DIR})
endfunction()
fovea_import(GeographicLib::GeographicLib GeographicLib/LocalCartesian.hpp GeographicLib)
fovea_import(zstd::zstd zstd.h zstd)
fovea_import(libdeflate::libdeflate libdeflate.h deflate)
fovea_import(embree::embree embree3/rtcore.h embree3)
fovea_import(xxhash::xxhash xxhash.h xxhash)
