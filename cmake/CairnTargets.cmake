# What the targets of the project are built with.

# The root of the sources as an include path: "simd/target.h", "bench/scenes/...". Never installed.
add_library(cairn_source_root INTERFACE)
target_include_directories(cairn_source_root INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)

# Makes targets of others, which were found in this folder, known in all of them: a parent project that adds this
# project links our targets without finding theirs. CMake lets nobody do that for what a parent has found.
function(cairn_global)
  get_property(found_here DIRECTORY PROPERTY IMPORTED_TARGETS)
  foreach(target ${ARGN})
    if(TARGET ${target} AND target IN_LIST found_here)
      set_target_properties(${target} PROPERTIES IMPORTED_GLOBAL TRUE)
    endif()
  endforeach()
endfunction()

# Shared libraries choose by a list what they show (cmake/exports). A parent project that hides everything hides more.
if(BUILD_SHARED_LIBS AND CMAKE_CXX_VISIBILITY_PRESET)
  set(CMAKE_CXX_VISIBILITY_PRESET default)
  set(CMAKE_VISIBILITY_INLINES_HIDDEN OFF)
endif()

# Warnings where this is not part of another project, no fused multiply-add behind our back (results must not depend on
# the target), sanitizers. Optimised also where a parent project has no build type.
# Nobody replaces single functions of ours: else code for shared libraries could not inline them. Nor are variables
# unique in the process: a plugin that has them could not be unloaded.
function(cairn_strict target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Kernels include themselves, once per target.
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  if(MSVC)  # not tried; there /fp:precise fuses nothing since Visual Studio 2022
    target_compile_options(${target} PRIVATE /W4 /permissive- /fp:precise $<$<BOOL:${CAIRN_WERROR}>:/WX>)
    return()
  endif()
  target_compile_options(${target} PRIVATE $<$<CONFIG:>:-O3 -DNDEBUG> -ffp-contract=off
                                           -fno-semantic-interposition -Wno-psabi
                                           $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-gnu-unique>
                                           $<$<BOOL:${CAIRN_WERROR}>:-Werror>)
  if(PROJECT_IS_TOP_LEVEL)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow)
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    # Eigen would fuse multiplications and additions here, as it cannot on x86 without flags.
    target_compile_options(${target} PRIVATE -U__ARM_FEATURE_FMA)
  endif()
  if(CAIRN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${CAIRN_SANITIZE} -fno-sanitize-recover=all
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${CAIRN_SANITIZE})
  endif()
endfunction()

# What no benchmark times - tools, scenes, tests - is compiled in a fraction of the time: cairn_untimed(targets...), of
# which those that are not there are passed over. Files of one folder are compiled as one file, but where they reuse
# names of helpers. With -DCMAKE_UNITY_BUILD=OFF each file is compiled alone; there an include that is missing is seen.
set(CAIRN_UNTIMED $<$<NOT:$<OR:$<CONFIG:Debug>,$<CXX_COMPILER_ID:MSVC>>>:-O1>)
set(CAIRN_ALONE "^(bench/(frames|scenes.*|worlds/conditions)|core/src/cholesky|tests/(simd|core/(frame|lcp)|bench.*))$")
function(cairn_untimed)
  foreach(target ${ARGN})
    if(TARGET ${target})
      target_compile_options(${target} PRIVATE ${CAIRN_UNTIMED})
      cairn_by_folder(${target})
    endif()
  endforeach()
endfunction()

function(cairn_by_folder target)
  if(DEFINED CMAKE_UNITY_BUILD AND NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes what others include for a header, where a class must not have members from unnamed namespaces
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(folder ${source} ABSOLUTE)
    get_filename_component(folder ${folder} DIRECTORY)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${folder} made_here)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    if(NOT made_here AND NOT folder MATCHES "${CAIRN_ALONE}")
      string(REPLACE / _ folder ${folder})
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
    endif()
  endforeach()
endfunction()

# With tests, headers of others are compiled once for all targets that use them, which halves the time of a build:
# cairn_headers(name HEADERS ... [LIBS ...] [DEFINITIONS ...] [OPTIONS ...] [PIC]) and cairn_use_headers(target name).
# Options become those of the targets. Definitions must be, where headers look at them. A library without tests is
# built without: there an include that is missing is seen. CMAKE_DISABLE_PRECOMPILE_HEADERS leaves them out.
function(cairn_headers name)
  if(NOT CAIRN_TESTS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "PIC" "" "HEADERS;LIBS;DEFINITIONS;OPTIONS")
  # so that ccache, with CCACHE_SLOPPINESS=pch_defines,time_macros, keeps what is compiled with them
  list(APPEND arg_OPTIONS $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "// nothing but headers\n")
  add_library(${name} OBJECT ${source})
  cairn_strict(${name})
  target_link_libraries(${name} PRIVATE ${arg_LIBS})
  target_compile_definitions(${name} PRIVATE ${arg_DEFINITIONS})
  target_compile_options(${name} PRIVATE ${arg_OPTIONS})
  set_property(TARGET ${name} PROPERTY CAIRN_OPTIONS ${arg_OPTIONS})
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ${arg_PIC})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
endfunction()

function(cairn_use_headers target name)
  if(TARGET ${name})
    get_property(options TARGET ${name} PROPERTY CAIRN_OPTIONS)
    target_compile_options(${target} PRIVATE ${options})
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

# Threads of oneTBB may still be on their way out of a library when it is closed: it stays, as oneTBB with it.
function(cairn_stays target)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE LINKER:-z,nodelete)
  endif()
endfunction()

set(CAIRN_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# A shared library shows the names that cmake/exports/<file>.map.in lists.
function(cairn_show target file)
  string(REGEX REPLACE "-float64$" "" map ${file})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/exports/${map}.map.in ${CMAKE_CURRENT_BINARY_DIR}/${file}.map @ONLY)
  target_link_options(${target} PRIVATE LINKER:--version-script=${CMAKE_CURRENT_BINARY_DIR}/${file}.map)
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/${file}.map)
endfunction()

# A library of C++ that is built with tests shows all, as they test what is inside.
set(CAIRN_HIDES OFF)
if(BUILD_SHARED_LIBS AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT CAIRN_TESTS)
  set(CAIRN_HIDES ON)
endif()

# A library of the product: cairn_library(target alias sources...) makes <target>, cairn::<alias> and the
# file libcairn or libcairn-<alias>.
function(cairn_library target alias)
  add_library(${target} ${ARGN})
  add_library(cairn::${alias} ALIAS ${target})
  set(file cairn-${alias})
  if(alias STREQUAL "cairn")
    set(file cairn)
  endif()
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${alias} OUTPUT_NAME ${file} POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION} SOVERSION ${CAIRN_SOVERSION} DEFINE_SYMBOL "" INSTALL_RPATH "$ORIGIN")
  cairn_strict(${target})
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    cairn_by_folder(${target})  # nobody times it
  endif()
  cairn_stays(${target})
  if(CAIRN_HIDES)
    cairn_show(${target} ${file})
  endif()
endfunction()

# Builds a target against Bullet in one precision (float or float64). Everything that links the target
# does so too: a target that would get both precisions is refused when CMake generates.
function(cairn_bullet_precision target precision)
  if(precision STREQUAL "float")
    target_link_libraries(${target} PUBLIC cairn::bullet3)
  elseif(precision STREQUAL "float64")
    target_link_libraries(${target} PUBLIC cairn::bullet3-float64)
  else()
    message(FATAL_ERROR "cairn_bullet_precision(${target} ${precision}): float or float64")
  endif()
endfunction()

# A program that users start: <build>/bin/<name>, installed as <prefix>/bin/<name>.
function(cairn_program target name)
  add_executable(${target} ${ARGN})
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin
    INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  cairn_strict(${target})
  set_property(GLOBAL APPEND PROPERTY CAIRN_PROGRAMS ${target})
endfunction()
