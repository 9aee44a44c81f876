# In the clone our headers include each other as "scalar/jet.h", seen from lib/. Installed, they say
# <isoparm/scalar/jet.h>, so that a user's own "mesh.h" and ours never meet.
file(GLOB_RECURSE headers "${ISOPARM_HEADERS}/*.h")
foreach(header IN LISTS headers)
    file(READ "${header}" text)
    string(REGEX REPLACE "#include \"([^\"]+)\"" "#include <isoparm/\\1>" changed "${text}")
    if(NOT changed STREQUAL text)
        file(WRITE "${header}" "${changed}")
    endif()
endforeach()
