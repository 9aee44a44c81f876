# Finds the libraries, around what is wrong with some of their CMake files. Targets afterwards: TBB::tbb,
# OpenSubdiv::osdCPU, embree, JsonCpp::JsonCpp, OpenImageIO::OpenImageIO, PkgConfig::PANGOCAIRO, PNG::PNG.

# Ends with the names under which systems ship what was not found: the row of packages.txt.
function(isoparm_not_found what debian_package)
    file(STRINGS "${PROJECT_SOURCE_DIR}/cmake/packages.txt" row REGEX "^[a-z]+ +[|] ${debian_package} ")
    string(REGEX REPLACE " *[|] *" ";" row "${row}")
    list(GET row 3 fedora)
    list(GET row 4 arch)
    list(GET row 5 homebrew)
    list(GET row 6 why)
    message(FATAL_ERROR "isoparm: ${what} was not found (${why}). Install it:\n"
        "  Debian, Ubuntu:  apt-get install ${debian_package}\n"
        "  Fedora:          dnf install ${fedora}\n"
        "  Arch:            pacman -S ${arch}\n"
        "  Homebrew:        brew install ${homebrew}\n"
        "or add the folder where it lies to CMAKE_PREFIX_PATH.")
endfunction()

find_package(TBB CONFIG QUIET)
if(NOT TARGET TBB::tbb)
    isoparm_not_found(TBB libtbb-dev)
endif()

list(PREPEND CMAKE_MODULE_PATH "${PROJECT_SOURCE_DIR}/cmake")
find_package(OpenSubdiv MODULE QUIET)
list(POP_FRONT CMAKE_MODULE_PATH)
if(NOT OpenSubdiv_FOUND)
    isoparm_not_found(OpenSubdiv libosd-dev)
endif()

find_package(embree 4 CONFIG QUIET)
if(NOT TARGET embree)
    find_package(embree 3 CONFIG QUIET)
endif()
if(NOT TARGET embree)
    isoparm_not_found("Embree 3 or 4" libembree-dev)
endif()

find_package(jsoncpp CONFIG QUIET)
if(NOT TARGET JsonCpp::JsonCpp)
    if(TARGET jsoncpp_lib)  # before 1.9.5
        add_library(JsonCpp::JsonCpp ALIAS jsoncpp_lib)
    else()
        isoparm_not_found(JsonCpp libjsoncpp-dev)
    endif()
endif()

find_package(PkgConfig QUIET)
if(NOT PKG_CONFIG_FOUND)
    isoparm_not_found(pkg-config pkg-config)
endif()
pkg_check_modules(PANGOCAIRO QUIET IMPORTED_TARGET pangocairo)
if(NOT TARGET PkgConfig::PANGOCAIRO)
    isoparm_not_found("Pango with Cairo" libpango1.0-dev)
endif()

find_package(PNG QUIET)
if(NOT TARGET PNG::PNG)
    isoparm_not_found(libpng libpng-dev)
endif()

# Debian's OpenImageIO ends the configuration with a cryptic error if its programs, another package, are not there.
find_program(ISOPARM_OIIOTOOL oiiotool)
mark_as_advanced(ISOPARM_OIIOTOOL)
if(NOT ISOPARM_OIIOTOOL)
    isoparm_not_found("oiiotool of OpenImageIO" openimageio-tools)
endif()
find_package(OpenImageIO CONFIG QUIET)
if(NOT TARGET OpenImageIO::OpenImageIO)
    isoparm_not_found(OpenImageIO libopenimageio-dev)
endif()
# ... and it lists include folders of packages that it does not depend on.
foreach(target OpenImageIO::OpenImageIO OpenImageIO::OpenImageIO_Util)
    foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
        get_target_property(folders ${target} ${property})
        if(folders)
            set(existing "")
            foreach(folder IN LISTS folders)
                if(EXISTS "${folder}")
                    list(APPEND existing "${folder}")
                endif()
            endforeach()
            set_property(TARGET ${target} PROPERTY ${property} "${existing}")
        endif()
    endforeach()
endforeach()

# Optional: OpenCASCADE, a tessellator to compare with (its own CMake files want all of its packages installed).
find_path(OpenCASCADE_INCLUDE_DIR BRepMesh_IncrementalMesh.hxx PATH_SUFFIXES opencascade)
mark_as_advanced(OpenCASCADE_INCLUDE_DIR)
foreach(library TKMesh TKTopAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath TKernel)
    find_library(OpenCASCADE_${library} ${library})
    mark_as_advanced(OpenCASCADE_${library})
endforeach()
