# Finds OpenSubdiv's CPU library: target OpenSubdiv::osdCPU. Not by its own CMake files, because Debian's name a static
# library that is not shipped.
find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/version.h)
find_library(OpenSubdiv_LIBRARY osdCPU)
mark_as_advanced(OpenSubdiv_INCLUDE_DIR OpenSubdiv_LIBRARY)

if(OpenSubdiv_INCLUDE_DIR)
    file(STRINGS "${OpenSubdiv_INCLUDE_DIR}/opensubdiv/version.h" version REGEX "define OPENSUBDIV_VERSION_(MAJOR|MINOR|PATCH) ")
    string(REGEX REPLACE "[^0-9]*([0-9]+)" "\\1." version "${version}")
    string(REGEX MATCH "^[0-9]+[.][0-9]+[.][0-9]+" OpenSubdiv_VERSION "${version}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv
    REQUIRED_VARS OpenSubdiv_LIBRARY OpenSubdiv_INCLUDE_DIR VERSION_VAR OpenSubdiv_VERSION)

if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
    add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
    set_target_properties(OpenSubdiv::osdCPU PROPERTIES
        IMPORTED_LOCATION "${OpenSubdiv_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}")
endif()
