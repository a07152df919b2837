# The version of the installed airlight, as airlight.pc has it. Before 1.0 another minor version is another interface.

get_filename_component(_airlight_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
file(GLOB _airlight_pc "${_airlight_prefix}/lib*/pkgconfig/airlight.pc" "${_airlight_prefix}/lib*/*/pkgconfig/airlight.pc")
list(GET _airlight_pc 0 _airlight_pc)
file(STRINGS "${_airlight_pc}" PACKAGE_VERSION REGEX "^Version: ")
string(REPLACE "Version: " "" PACKAGE_VERSION "${PACKAGE_VERSION}")

string(REGEX MATCH "^(0\\.)?[0-9]+" _airlight_have "${PACKAGE_VERSION}")
string(REGEX MATCH "^(0\\.)?[0-9]+" _airlight_want "${PACKAGE_FIND_VERSION}")
if(NOT PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION AND _airlight_have STREQUAL _airlight_want)
    set(PACKAGE_VERSION_COMPATIBLE TRUE)
    if(PACKAGE_VERSION VERSION_EQUAL PACKAGE_FIND_VERSION)
        set(PACKAGE_VERSION_EXACT TRUE)
    endif()
endif()
