# Finds Bullet Physics in both precisions, or in those that COMPONENTS names (float, float64):
#
#   cairn::bullet3          btScalar = float
#   cairn::bullet3-float64  btScalar = double (carries BT_USE_DOUBLE_PRECISION)
#
# Bullet's own CMake config has no targets, and Debian's is broken (relative include path, missing use file);
# CMake's module finds the float libraries only. This looks for headers and libraries itself; pass
# -DBULLET_ROOT=/prefix (or Bullet_ROOT, or either in the environment) for a Bullet that is not in a standard place:
# no other is taken then.
#
# A Bullet whose locks lock is one for several threads (BT_THREADSAFE, cmake/build-bullet-mt.sh): its targets then
# carry that definition, which what is inline in its headers needs as well. A program of a few lines is run to
# find out; where none can be run, set CAIRN_BULLET_THREADSAFE.
#
# The two precisions export the same mangled names, so a program that has both crashes: each target says which
# one it is (CAIRN_BULLET_PRECISION), and CMake refuses a target that links both.
include(FindPackageHandleStandardArgs)
set(_cairn_bullet_roots ${BULLET_ROOT} ${Bullet_ROOT} $ENV{BULLET_ROOT} $ENV{Bullet_ROOT})
set(_cairn_bullet_places)
if(_cairn_bullet_roots)
  set(_cairn_bullet_places NO_DEFAULT_PATH)
endif()
# What was found for other roots is not theirs.
if(DEFINED CAIRN_BULLET_ROOTS AND NOT "${CAIRN_BULLET_ROOTS}" STREQUAL "${_cairn_bullet_roots}")
  unset(CAIRN_BULLET_INCLUDE_DIR CACHE)
  unset(CAIRN_BULLET_THREADSAFE_OF CACHE)
  foreach(part BulletDynamics BulletCollision LinearMath)
    unset(CAIRN_${part}_LIBRARY CACHE)
    unset(CAIRN_${part}-float64_LIBRARY CACHE)
  endforeach()
endif()
set(CAIRN_BULLET_ROOTS "${_cairn_bullet_roots}" CACHE INTERNAL "Where Bullet was looked for")

# Found means one precision at least, or the only one that was asked for; ask for the targets to know which.
find_path(CAIRN_BULLET_INCLUDE_DIR NAMES btBulletDynamicsCommon.h
          HINTS ${_cairn_bullet_roots} PATH_SUFFIXES include/bullet bullet ${_cairn_bullet_places})

# Sets CAIRN_BULLET_THREADSAFE, once for each Bullet: whether a lock that is held cannot be had by another.
function(_cairn_try_bullet_locks library)
  if("${CAIRN_BULLET_THREADSAFE_OF}" STREQUAL "${library}" OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  if(NOT "CXX" IN_LIST languages)
    return()
  endif()
  set(source ${CMAKE_BINARY_DIR}/CMakeFiles/cairn_bullet_locks.cc)
  file(WRITE ${source} "#include <LinearMath/btThreads.h>\n"
    "int main() { btSpinMutex lock; lock.tryLock(); return lock.tryLock() ? 1 : 0; }\n")
  try_run(locks compiles ${CMAKE_BINARY_DIR}/CMakeFiles/cairn_bullet_locks ${source}
    CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${CAIRN_BULLET_INCLUDE_DIR} LINK_LIBRARIES ${library})
  set(threadsafe OFF)
  if(compiles AND "${locks}" STREQUAL "0")
    set(threadsafe ON)
  endif()
  unset(locks CACHE)
  unset(compiles CACHE)
  set(CAIRN_BULLET_THREADSAFE ${threadsafe} CACHE BOOL "Bullet was built with BT_THREADSAFE" FORCE)
  set(CAIRN_BULLET_THREADSAFE_OF ${library} CACHE INTERNAL "The library that was asked")
  mark_as_advanced(CAIRN_BULLET_THREADSAFE)
endfunction()

function(_cairn_find_bullet target suffix precision definition)
  set(libraries)
  foreach(part BulletDynamics BulletCollision LinearMath)
    find_library(CAIRN_${part}${suffix}_LIBRARY NAMES ${part}${suffix}
                 HINTS ${_cairn_bullet_roots} PATH_SUFFIXES lib lib64 lib/${CMAKE_LIBRARY_ARCHITECTURE} ${_cairn_bullet_places})
    mark_as_advanced(CAIRN_${part}${suffix}_LIBRARY)
    if(NOT CAIRN_${part}${suffix}_LIBRARY)
      return()
    endif()
    list(APPEND libraries ${CAIRN_${part}${suffix}_LIBRARY})
  endforeach()
  set(CairnBullet_LIBRARIES ${CairnBullet_LIBRARIES} ${libraries} PARENT_SCOPE)
  if(NOT CAIRN_BULLET_INCLUDE_DIR OR TARGET cairn::${target})
    return()
  endif()
  if(suffix STREQUAL "")
    _cairn_try_bullet_locks(${CAIRN_LinearMath_LIBRARY})
  elseif(NOT CAIRN_LinearMath_LIBRARY)
    _cairn_try_bullet_locks(${CAIRN_LinearMath${suffix}_LIBRARY})
  endif()
  if(CAIRN_BULLET_THREADSAFE)
    list(APPEND definition BT_THREADSAFE=1)
  endif()
  add_library(cairn::${target} INTERFACE IMPORTED)
  set_target_properties(cairn::${target} PROPERTIES
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${CAIRN_BULLET_INCLUDE_DIR}
    INTERFACE_INCLUDE_DIRECTORIES ${CAIRN_BULLET_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${libraries}"
    INTERFACE_COMPILE_DEFINITIONS "${definition}"
    INTERFACE_CAIRN_BULLET_PRECISION ${precision}
    COMPATIBLE_INTERFACE_STRING CAIRN_BULLET_PRECISION)
endfunction()

set(CairnBullet_LIBRARIES)
if(NOT CairnBullet_FIND_COMPONENTS OR float IN_LIST CairnBullet_FIND_COMPONENTS)
  _cairn_find_bullet(bullet3 "" float "")
endif()
if(NOT CairnBullet_FIND_COMPONENTS OR float64 IN_LIST CairnBullet_FIND_COMPONENTS)
  _cairn_find_bullet(bullet3-float64 "-float64" float64 BT_USE_DOUBLE_PRECISION)
endif()

if(CAIRN_BULLET_INCLUDE_DIR AND EXISTS ${CAIRN_BULLET_INCLUDE_DIR}/LinearMath/btScalar.h)
  file(STRINGS ${CAIRN_BULLET_INCLUDE_DIR}/LinearMath/btScalar.h _cairn_bullet_line
       REGEX "#define BT_BULLET_VERSION [0-9]+")
  string(REGEX MATCH "[0-9]+" _cairn_bullet_number "${_cairn_bullet_line}")
  math(EXPR _cairn_bullet_major "${_cairn_bullet_number} / 100")
  math(EXPR _cairn_bullet_minor "${_cairn_bullet_number} % 100")
  set(CairnBullet_VERSION ${_cairn_bullet_major}.${_cairn_bullet_minor})
endif()

set(_cairn_bullet_missing "Debian and Ubuntu: apt-get install libbullet-dev")
if(_cairn_bullet_roots)
  set(_cairn_bullet_missing "looked in BULLET_ROOT alone, ${_cairn_bullet_roots}")
endif()
find_package_handle_standard_args(CairnBullet
  REQUIRED_VARS CAIRN_BULLET_INCLUDE_DIR CairnBullet_LIBRARIES
  VERSION_VAR CairnBullet_VERSION
  REASON_FAILURE_MESSAGE "${_cairn_bullet_missing}")
mark_as_advanced(CAIRN_BULLET_INCLUDE_DIR)
