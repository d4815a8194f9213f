# SPDX-License-Identifier: Apache-2.0
# Writes a source file that holds files as they are now, by the paths under which they are served.
#   cmake -DOUTPUT=web_files.cc -DFOLDER=web -DFILES=/index.html=index.html,/app.js=app.js -DIMPORTS=three=/lib/three.js -P embed_files.cmake
# In modules, what is imported by a NAME of IMPORTS (NAME=PATH) is imported from the PATH: a browser does not know where packages are.
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_json "application/json")
set(types_svg "image/svg+xml")

string(REPLACE "," ";" FILES "${FILES}")
string(REPLACE "," ";" IMPORTS "${IMPORTS}")
set(arrays "")
set(entries "")
set(number 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
  set(path "${CMAKE_MATCH_1}")
  set(file "${CMAKE_MATCH_2}")
  get_filename_component(extension "${file}" LAST_EXT)
  string(SUBSTRING "${extension}" 1 -1 extension)
  if(NOT DEFINED types_${extension})
    message(FATAL_ERROR "${file}: no content type is known for .${extension}")
  endif()
  file(READ "${FOLDER}/${file}" bytes HEX)
  foreach(import IN LISTS IMPORTS)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${import}")
    string(HEX "from '${CMAKE_MATCH_1}'" by_name)
    string(HEX "from '${CMAKE_MATCH_2}'" by_path)
    string(REPLACE "${by_name}" "${by_path}" bytes "${bytes}")
  endforeach()
  # A string literal: it compiles many times faster than a list of characters. It ends in a NUL that the file has not.
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
  string(APPEND arrays "constexpr char kFile${number}[] = \"${bytes}\";\n")
  string(APPEND entries "    {\"${path}\", \"${types_${extension}}\", {kFile${number}, sizeof kFile${number} - 1}},\n")
  math(EXPR number "${number} + 1")
endforeach()

file(WRITE "${OUTPUT}" "#include \"server/routes/web_files.h\"

namespace server {

namespace {

${arrays}
constexpr WebFile kFiles[] = {
${entries}};

}  // namespace

const WebFile* find_web_file(std::string_view path) {
  for (const WebFile& file : kFiles) {
    if (file.path == path) return &file;
  }
  return nullptr;
}

}  // namespace server
")
