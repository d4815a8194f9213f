# SPDX-License-Identifier: Apache-2.0
# Compresses files as they are now, and writes a source file that holds them by the paths under which they are served.
#   cmake -DOUTPUT=web_files.cc -DFOLDER=web -DFILES=/lib/three.js=node_modules/three/three.js,/app.js=app.js
#         -DIMPORTS=three=/lib/three.js -P embed_files.cmake
# In modules, a NAME of IMPORTS (NAME=PATH) is replaced by its PATH: a browser does not know where packages are.
# A file of node_modules is served as /lib/three.HASH.js, too, with the hash of its content. Files that stand after it in
# FILES ask for it by that name.
# Sources name each other from the root, "/core/api.js". What is served names them from where it stands, "../core/api.js",
# since a proxy may show the service under a path. Pages are served in the root: /, /docs.
set(types_html "text/html; charset=utf-8")
set(types_css "text/css; charset=utf-8")
set(types_js "text/javascript; charset=utf-8")
set(types_json "application/json")
set(types_svg "image/svg+xml")

string(REPLACE "," ";" FILES "${FILES}")
string(REPLACE "," ";" IMPORTS "${IMPORTS}")
set(scratch "${OUTPUT}.parts")
file(REMOVE_RECURSE "${scratch}")
file(MAKE_DIRECTORY "${scratch}")
set(parts "")
set(rows "")
set(packages "")
set(offset 0)
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.+)$" matched "${entry}")
  set(path "${CMAKE_MATCH_1}")
  set(file "${CMAKE_MATCH_2}")
  get_filename_component(extension "${file}" LAST_EXT)
  string(SUBSTRING "${extension}" 1 -1 extension)
  if(NOT DEFINED types_${extension})
    message(FATAL_ERROR "${file}: no content type is known for .${extension}")
  endif()

  file(READ "${FOLDER}/${file}" text)
  foreach(import IN LISTS IMPORTS)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${import}")
    string(REPLACE "from '${CMAKE_MATCH_1}'" "from '${CMAKE_MATCH_2}'" text "${text}")
  endforeach()
  foreach(package IN LISTS packages)
    foreach(quote "'" "\"")
      string(REPLACE "${quote}${package}${quote}" "${quote}${hashed_${package}}${quote}" text "${text}")
    endforeach()
  endforeach()

  if(extension STREQUAL "js")
    string(REGEX MATCHALL "[^/]+/" folders "${path}")
    list(TRANSFORM folders REPLACE ".+" "../")
    string(JOIN "" up "./" ${folders})
    foreach(before "from " "import(")
      foreach(quote "'" "\"")
        string(REPLACE "${before}${quote}/" "${before}${quote}${up}" text "${text}")
      endforeach()
    endforeach()
  elseif(extension STREQUAL "html")
    foreach(attribute href src)
      string(REPLACE "${attribute}=\"/" "${attribute}=\"" text "${text}")
    endforeach()
  endif()

  list(LENGTH parts number)
  set(part "${scratch}/${number}")
  file(WRITE "${part}" "${text}")
  execute_process(COMMAND gzip --best --no-name --stdout "${part}"
                  OUTPUT_FILE "${part}.gz" COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND parts "${part}.gz")
  file(SIZE "${part}" size)
  file(SIZE "${part}.gz" gzip_size)
  file(SHA256 "${part}" hash)
  file(SHA256 "${part}.gz" gzip_hash)
  string(SUBSTRING "${hash}" 0 32 hash)
  string(SUBSTRING "${gzip_hash}" 0 32 gzip_hash)
  set(row "\"${types_${extension}}\", {rpsup_web_files + ${offset}, ${gzip_size}}, ${size}")
  string(APPEND row ", R\"(\"${hash}\")\", R\"(\"${gzip_hash}\")\"")
  string(APPEND rows "    {\"${path}\", ${row}, WebFile::Path::kNamed},\n")
  if(file MATCHES "^node_modules/")
    string(SUBSTRING "${hash}" 0 16 short_hash)
    string(REGEX REPLACE "(\\.[a-z]+)$" ".${short_hash}\\1" hashed_${path} "${path}")
    list(APPEND packages "${path}")
    string(APPEND rows "    {\"${hashed_${path}}\", ${row}, WebFile::Path::kHashed},\n")
  endif()
  math(EXPR offset "${offset} + ${gzip_size}")
endforeach()

execute_process(COMMAND cat ${parts} OUTPUT_FILE "${OUTPUT}.bin" COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE "${scratch}")
file(WRITE "${OUTPUT}" "#include \"server/routes/web_files.h\"

// The compressed files, one after the other. The assembler takes them as they are.
asm(\".pushsection .rodata\\n\"
    \".globl rpsup_web_files\\n\"
    \".hidden rpsup_web_files\\n\"
    \"rpsup_web_files:\\n\"
    \".incbin \\\"${OUTPUT}.bin\\\"\\n\"
    \".popsection\\n\");
extern \"C\" const char rpsup_web_files[${offset}];

namespace server {

namespace {

constexpr WebFile kFiles[] = {
${rows}};

}  // namespace

const WebFile* find_web_file(std::string_view path) {
  for (const WebFile& file : kFiles) {
    if (file.path == path) return &file;
  }
  return nullptr;
}

}  // namespace server
")
