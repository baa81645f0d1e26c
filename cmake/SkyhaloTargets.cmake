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

# Compiling the sources of a folder together takes less than half of the time. For a build that is made from nothing and
# then used: who works on a source wants it alone, and CI compiles the library's so, for each to include what it needs.
set(SKYHALO_JOIN_SOURCES "none" CACHE STRING "Sources that are compiled together: none, programs or all")
set_property(CACHE SKYHALO_JOIN_SOURCES PROPERTY STRINGS none programs all)

# Called when a target has all its sources.
function(skyhalo_join_sources target)
  get_target_property(type ${target} TYPE)
  if(SKYHALO_JOIN_SOURCES STREQUAL "none" OR (SKYHALO_JOIN_SOURCES STREQUAL "programs" AND NOT type STREQUAL
                                                                                            "EXECUTABLE"))
    return()
  endif()
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  get_target_property(sources ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)
  set(files "")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY "${folder}")
    if(EXISTS "${source}")
      list(APPEND files "${source}")
    endif()
  endforeach()
  execute_process(
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/tools/source_units.py" 10 ${files}
    OUTPUT_VARIABLE units COMMAND_ERROR_IS_FATAL ANY OUTPUT_STRIP_TRAILING_WHITESPACE)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes a joined source for a header, where a type of the unnamed namespace would be a mistake.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  string(REPLACE ";" "|" units "${units}")
  string(REPLACE "\n" ";" units "${units}")
  foreach(unit IN LISTS units)
    string(REPLACE "|" ";" unit "${unit}")
    list(LENGTH unit length)
    list(GET unit 0 first)
    if(length GREATER 1)
      cmake_path(RELATIVE_PATH first BASE_DIRECTORY "${PROJECT_SOURCE_DIR}" OUTPUT_VARIABLE name)
      string(MAKE_C_IDENTIFIER "${name}" name)
      set_source_files_properties(${unit} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP "${name}")
    endif()
  endforeach()
endfunction()

# Adds the target `<target>_headers`, which compiles each public header by itself, as a user of the library does. Left
# out are those that a source of the same name includes before anything else (`tools/check_layers.cmake` sees to it).
function(skyhalo_verify_headers target)
  get_target_property(headers ${target} HEADER_SET)
  set(sources "")
  foreach(header IN LISTS headers)
    cmake_path(REPLACE_EXTENSION header LAST_ONLY cpp OUTPUT_VARIABLE own_source)
    if(NOT EXISTS "${own_source}")
      string(REGEX REPLACE "^.*/skyhalo/" "skyhalo/" name "${header}")
      set(source "${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp")
      file(CONFIGURE OUTPUT "${source}" CONTENT "#include <${name}>\n")
      list(APPEND sources "${source}")
    endif()
  endforeach()
  add_library(${target}_headers OBJECT EXCLUDE_FROM_ALL ${sources})
  skyhalo_target_defaults(${target}_headers)
  target_link_libraries(${target}_headers PRIVATE ${target})
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
