# Finds Bullet Physics in both precisions, or in those that COMPONENTS names (float, float64):
#
#   cairn::bullet3          btScalar = float
#   cairn::bullet3-float64  btScalar = double (carries BT_USE_DOUBLE_PRECISION)
#
# Bullet's own CMake config has no targets, and Debian's is broken (relative include path, missing use file);
# CMake's module finds the float libraries only. This looks for headers and libraries itself; pass
# -DBullet_ROOT=/prefix for a Bullet that is not in a standard place.
#
# The two precisions export the same mangled names, so a program that has both crashes: each target says which
# one it is (CAIRN_BULLET_PRECISION), and CMake refuses a target that links both.
include(FindPackageHandleStandardArgs)

# Found means one precision at least, or the only one that was asked for; ask for the targets to know which.
find_path(CAIRN_BULLET_INCLUDE_DIR NAMES btBulletDynamicsCommon.h
          HINTS ${Bullet_ROOT} $ENV{Bullet_ROOT} PATH_SUFFIXES include/bullet bullet)

function(_cairn_find_bullet target suffix precision definition)
  set(libraries)
  foreach(part BulletDynamics BulletCollision LinearMath)
    find_library(CAIRN_${part}${suffix}_LIBRARY NAMES ${part}${suffix}
                 HINTS ${Bullet_ROOT} $ENV{Bullet_ROOT} PATH_SUFFIXES lib)
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

find_package_handle_standard_args(CairnBullet
  REQUIRED_VARS CAIRN_BULLET_INCLUDE_DIR CairnBullet_LIBRARIES
  VERSION_VAR CairnBullet_VERSION
  REASON_FAILURE_MESSAGE "Debian and Ubuntu: apt-get install libbullet-dev")
mark_as_advanced(CAIRN_BULLET_INCLUDE_DIR)
