# Settings that every target of the project shares.

# A build without a type is an optimised one; the user's own choice stays.
get_property(is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(PROJECT_IS_TOP_LEVEL AND NOT is_multi_config AND NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Kind of build" FORCE)
endif()

# `-O2 -g` is CMake's RelWithDebInfo; assertions of the libraries stay off there as in Release.
function(skyhalo_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(
    ${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                      -Wnon-virtual-dtor -Woverloaded-virtual)
endfunction()

# Makes `variable` a std::string_view with the bytes of `file`: a generated source for `target`.
function(skyhalo_embed_text target file variable header)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${variable}.cpp")
  add_custom_command(
    OUTPUT "${source}"
    COMMAND ${CMAKE_COMMAND} -D "INPUT=${file}" -D "OUTPUT=${source}" -D "VARIABLE=${variable}" -D
            "HEADER=${header}" -P "${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake"
    DEPENDS "${file}" "${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake"
    COMMENT "Embedding ${file}"
    VERBATIM)
  target_sources(${target} PRIVATE "${source}")
endfunction()
