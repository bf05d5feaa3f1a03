# Finds Highway, or with CAIRN_FETCH_DEPENDENCIES fetches the version that is tested: hwy::hwy.
set(CAIRN_HIGHWAY_URL https://github.com/google/highway/archive/refs/tags/1.0.3.tar.gz CACHE STRING
    "Where CAIRN_FETCH_DEPENDENCIES gets Highway from, or a file: the same archive, which is checked")
mark_as_advanced(CAIRN_HIGHWAY_URL)

if(TARGET hwy::hwy)
  return()
endif()
if(NOT CAIRN_FETCH_DEPENDENCIES)
  find_package(hwy 1.0.3 REQUIRED)
  cairn_global(hwy::hwy)
  return()
endif()
find_package(hwy 1.0.3 QUIET)
if(hwy_FOUND)
  cairn_global(hwy::hwy)
  return()
endif()

include(FetchContent)
FetchContent_Declare(highway URL ${CAIRN_HIGHWAY_URL}
  URL_HASH SHA256=566fc77315878473d9a6bd815f7de78c73734acdcb745c3dde8579560ac5440e)
# Its library alone, which becomes part of ours.
set(BUILD_TESTING OFF)
set(BUILD_SHARED_LIBS OFF)
foreach(part CONTRIB EXAMPLES INSTALL TESTS)
  set(HWY_ENABLE_${part} OFF CACHE INTERNAL "")
endforeach()
set(HWY_FORCE_STATIC_LIBS ON CACHE INTERNAL "")
FetchContent_GetProperties(highway)
if(NOT highway_POPULATED)
  message(STATUS "cairn: fetching Highway from ${CAIRN_HIGHWAY_URL}")
  FetchContent_Populate(highway)
  add_subdirectory(${highway_SOURCE_DIR} ${highway_BINARY_DIR} EXCLUDE_FROM_ALL)
endif()
set_target_properties(hwy PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                     VISIBILITY_INLINES_HIDDEN ON)
add_library(hwy::hwy ALIAS hwy)
set(CAIRN_HIGHWAY_FETCHED TRUE CACHE INTERNAL "")
