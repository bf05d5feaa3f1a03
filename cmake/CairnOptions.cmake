# What is built. Defaults of the tools and tests follow what is installed: a plain `cmake -B build` configures
# with the packages of the library alone.

# An option that is on by itself in a build of its own, where the packages that it needs are found.
function(cairn_option_with_packages option description)
  set(missing)
  if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CACHE{${option}})
    foreach(package ${ARGN})
      if(package STREQUAL "Python3")
        find_package(Python3 3.9 QUIET COMPONENTS Interpreter)
      else()
        find_package(${package} QUIET)
      endif()
      if(NOT ${package}_FOUND)
        list(APPEND missing ${package})
      endif()
    endforeach()
  endif()
  set(default ${PROJECT_IS_TOP_LEVEL})
  if(missing)
    set(default OFF)
    list(JOIN missing ", " names)
    message(STATUS "cairn: ${option} is OFF, as these were not found: ${names}. packages.txt names their "
                   "packages; -D${option}=ON asks for it")
  endif()
  option(${option} "${description}" ${default})
endfunction()

cairn_option_with_packages(CAIRN_TOOLS "Build the cairn tool" CLI11 nlohmann_json fmt)
cairn_option_with_packages(CAIRN_TESTS "Build the tests" GTest rapidcheck Python3 nlohmann_json fmt)
option(CAIRN_EXAMPLES "Build the examples" ${PROJECT_IS_TOP_LEVEL})
option(CAIRN_INSTALL "Generate the install target" ${PROJECT_IS_TOP_LEVEL})
option(CAIRN_FUZZ "Build the fuzz targets (needs clang)" OFF)
option(CAIRN_WERROR "Treat warnings as errors" OFF)
# For builds from nothing that are not to be timed. ccache does not keep files compiled so, and an include of others
# that is missing is not seen.
option(CAIRN_QUICK_BUILD "Precompile headers of others, and optimise tool and tests less" OFF)
set(CAIRN_PAGE AUTO CACHE STRING "Scripts in the page of cairn run --report: AUTO (with npm, if it is found) or OFF")
set_property(CACHE CAIRN_PAGE PROPERTY STRINGS AUTO OFF)
set(CAIRN_SANITIZE "" CACHE STRING "Sanitizers to build with, as -fsanitize= takes them")

# The adapter: CAIRN_BULLET_PRECISIONS are the precisions of Bullet to build it for.
set(CAIRN_BULLET both CACHE STRING "Build the Bullet adapter (needs libbullet-dev): float, float64, both or off")
set_property(CACHE CAIRN_BULLET PROPERTY STRINGS both float float64 off)
string(TOLOWER "${CAIRN_BULLET}" cairn_bullet_word)
if(cairn_bullet_word MATCHES "^(both|on|true|yes|y|1)$")
  set(CAIRN_BULLET_PRECISIONS float float64)
elseif(cairn_bullet_word MATCHES "^float(64)?$")
  set(CAIRN_BULLET_PRECISIONS ${cairn_bullet_word})
elseif(cairn_bullet_word MATCHES "^(off|false|no|n|0|)$")
  set(CAIRN_BULLET_PRECISIONS)
else()
  message(FATAL_ERROR "CAIRN_BULLET is '${CAIRN_BULLET}': write float, float64, both or off")
endif()
