# The installed package, and the folder of sources, as other projects use them (tests/consumer/run.py).
# Sanitized libraries are not for others.
if(NOT CAIRN_INSTALL OR CAIRN_SANITIZE OR NOT TARGET cairn_bullet OR NOT TARGET cairn_bullet_float64)
  return()
endif()

function(cairn_consumer_test name way)
  add_test(NAME ${name}
    COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_SOURCE_DIR}/consumer/run.py ${way}
            --build ${PROJECT_BINARY_DIR} --cmake ${CMAKE_COMMAND} --cxx ${CMAKE_CXX_COMPILER} --cc ${CMAKE_C_COMPILER}
            --libdir ${CMAKE_INSTALL_LIBDIR})
  set_tests_properties(${name} PROPERTIES LABELS consumer ${ARGN})
endfunction()

cairn_consumer_test(install install FIXTURES_SETUP installed)
cairn_consumer_test(install_consumer_find_package find_package FIXTURES_REQUIRED installed)
cairn_consumer_test(install_consumer_without_eigen without_eigen FIXTURES_REQUIRED installed)
cairn_consumer_test(install_consumer_pkg_config pkg_config FIXTURES_REQUIRED installed)
cairn_consumer_test(install_consumer_strict_hosts strict_hosts FIXTURES_REQUIRED installed)
cairn_consumer_test(install_consumer_in_python python FIXTURES_REQUIRED installed
  SKIP_REGULAR_EXPRESSION "NumPy is missing")
if(NOT BUILD_SHARED_LIBS)
  cairn_consumer_test(install_consumer_in_c_alone c_alone FIXTURES_REQUIRED installed)
endif()
cairn_consumer_test(install_consumer_add_subdirectory add_subdirectory FIXTURES_SETUP unoptimised)
cairn_consumer_test(unoptimised_core_makes_the_same_bits unoptimised FIXTURES_REQUIRED unoptimised)
cairn_consumer_test(mixed_precisions_are_refused_by_cmake mixed_precisions FIXTURES_REQUIRED installed)
cairn_consumer_test(missing_component_is_named missing_component FIXTURES_REQUIRED installed)
cairn_consumer_test(wrong_precision_is_a_link_error wrong_precision FIXTURES_REQUIRED installed)
