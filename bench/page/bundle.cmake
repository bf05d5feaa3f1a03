# Writes BUILD/page_parts.cc from SOURCE/style.css and, where NPM is given and works, the bundle of the scripts.
cmake_minimum_required(VERSION 3.22)

# Sets `failure` if the step fails.
function(run_step what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE code OUTPUT_VARIABLE said
                  ERROR_VARIABLE said)
  if(NOT code EQUAL 0)
    set(failure "${what} failed (${code}): ${said}" PARENT_SCOPE)
  endif()
endfunction()

function(make_bundle)
  # what is installed already is kept while the lock file is the same
  file(SHA256 ${SOURCE}/package-lock.json wanted)
  set(installed "")
  if(EXISTS ${BUILD}/installed.txt)
    file(READ ${BUILD}/installed.txt installed)
  endif()
  if(NOT installed STREQUAL wanted)
    file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${BUILD})
    run_step("npm ci" ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
             --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-timeout=60000)
    if(failure)
      set(failure "${failure}" PARENT_SCOPE)
      return()
    endif()
    file(WRITE ${BUILD}/installed.txt ${wanted})
  endif()
  file(REMOVE_RECURSE ${BUILD}/src)
  file(COPY ${SOURCE}/src DESTINATION ${BUILD})
  run_step("esbuild" ${BUILD}/node_modules/.bin/esbuild src/main.js --bundle --minify --format=iife
           --target=es2020 --charset=ascii --legal-comments=none --loader:.css=text
           --outfile=bundled.js)
  set(failure "${failure}" PARENT_SCOPE)
endfunction()

# The notices that the licences ask for, and the scripts. "</script" must not occur in them.
function(write_bundle)
  set(text "/*\nThis script contains three.js and uPlot.\n")
  foreach(name three uplot)
    file(READ ${BUILD}/node_modules/${name}/LICENSE licence)
    string(APPEND text "\n${name}:\n${licence}\n")
  endforeach()
  file(READ ${BUILD}/bundled.js script)
  string(REPLACE "</script" "<\\/script" script "${script}")
  file(WRITE ${BUILD}/bundle.js "${text}*/\n${script}")
endfunction()

file(REMOVE ${BUILD}/bundle.js)
set(failure "")
if(NPM)
  make_bundle()
endif()
set(script "")
if(failure)
  message("Report page: without scripts, since ${failure}")
elseif(NPM)
  write_bundle()
  file(READ ${BUILD}/bundle.js script)
else()
  file(WRITE ${BUILD}/bundle.js "")
endif()
file(READ ${SOURCE}/style.css style)

file(WRITE ${BUILD}/page_parts.cc
"// SPDX-License-Identifier: MIT
#include \"page/page_parts.h\"

namespace cairn::cli {

std::string_view PageStyle() {
  return R\"cairn_page(${style})cairn_page\";
}

std::string_view PageScript() {
  return R\"cairn_page(${script})cairn_page\";
}

}  // namespace cairn::cli
")
