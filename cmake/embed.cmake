# Text files as C++ string constants, so that the program needs no files of its own beside it.
#   vsslam_embed(TARGET HEADER FILE...)  makes HEADER, with `inline constexpr std::string_view k_<file name>` for
#   each file (dots become underscores), and lets TARGET include it.
function(vsslam_embed target header)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  set(content "// Made from text files by cmake/embed.cmake.\n#pragma once\n\n#include <string_view>\n\nnamespace vsslam {\n\n")
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME)
    string(REPLACE "." "_" name ${name})
    file(READ ${file} text)
    string(APPEND content "inline constexpr std::string_view k_${name} = R\"embedded(${text})embedded\";\n\n")
  endforeach()
  string(APPEND content "}  // namespace vsslam\n")
  file(WRITE ${folder}/${header}.new "${content}")
  file(COPY_FILE ${folder}/${header}.new ${folder}/${header} ONLY_IF_DIFFERENT)
  target_include_directories(${target} PRIVATE ${folder})
endfunction()
