# find_package(airlight) gives the targets airlight::static and airlight::shared, as far as they are installed, and
# airlight::airlight, which is the shared one if there is one.
#
# `cargo cinstall --prefix PREFIX` puts this file into PREFIX/share/cmake/airlight.

get_filename_component(_airlight_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(_airlight_folders "${_airlight_prefix}/lib/${CMAKE_LIBRARY_ARCHITECTURE}" "${_airlight_prefix}/lib"
    "${_airlight_prefix}/lib64" "${_airlight_prefix}/bin")
find_package(Threads REQUIRED)

foreach(_airlight_kind STATIC SHARED)
    string(TOLOWER ${_airlight_kind} _airlight_target)
    set(_airlight_name "${CMAKE_${_airlight_kind}_LIBRARY_PREFIX}airlight${CMAKE_${_airlight_kind}_LIBRARY_SUFFIX}")
    unset(_airlight_library)
    foreach(_airlight_folder ${_airlight_folders})
        if(NOT _airlight_library AND EXISTS "${_airlight_folder}/${_airlight_name}")
            set(_airlight_library "${_airlight_folder}/${_airlight_name}")
        endif()
    endforeach()
    if(_airlight_library AND NOT TARGET airlight::${_airlight_target})
        add_library(airlight::${_airlight_target} ${_airlight_kind} IMPORTED)
        set_target_properties(airlight::${_airlight_target} PROPERTIES
            IMPORTED_LOCATION "${_airlight_library}"
            INTERFACE_INCLUDE_DIRECTORIES "${_airlight_prefix}/include")
        set(_airlight_found airlight::${_airlight_target})
    endif()
endforeach()

if(NOT _airlight_found)
    set(airlight_FOUND FALSE)
    set(airlight_NOT_FOUND_MESSAGE "there is no library of airlight in ${_airlight_folders}")
    return()
endif()
if(TARGET airlight::static)
    # What Rust's standard library needs.
    if(UNIX)
        set(_airlight_system Threads::Threads ${CMAKE_DL_LIBS} m)
    elseif(WIN32)
        set(_airlight_system ws2_32 userenv ntdll bcrypt)
    endif()
    set_property(TARGET airlight::static PROPERTY INTERFACE_LINK_LIBRARIES ${_airlight_system})
endif()
if(NOT TARGET airlight::airlight)
    add_library(airlight::airlight INTERFACE IMPORTED)
    set_property(TARGET airlight::airlight PROPERTY INTERFACE_LINK_LIBRARIES ${_airlight_found})
endif()
