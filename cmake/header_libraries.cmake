# Libraries of headers alone, for WebAssembly: they lie among the system's own headers, which another C library must not
# see, so each is reached through a link in the build folder.
function(gnomon_header_library target header)
  get_filename_component(folder ${header} DIRECTORY)
  find_path(GNOMON_${folder}_HEADERS ${header} PATHS /usr/include REQUIRED NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
  set(links ${CMAKE_BINARY_DIR}/headers)
  file(MAKE_DIRECTORY ${links})
  file(CREATE_LINK ${GNOMON_${folder}_HEADERS}/${folder} ${links}/${folder} SYMBOLIC)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${links})
endfunction()

gnomon_header_library(glm::glm glm/glm.hpp)
gnomon_header_library(hwy::hwy hwy/highway.h)
gnomon_header_library(nlohmann_json::nlohmann_json nlohmann/json.hpp)
target_compile_definitions(nlohmann_json::nlohmann_json INTERFACE JSON_HAS_FILESYSTEM=0 JSON_HAS_EXPERIMENTAL_FILESYSTEM=0)
