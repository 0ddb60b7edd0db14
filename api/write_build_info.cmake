# Writes build_info.cpp. HELIOGRAPH_COMMIT in the environment stands in where there is no git (docker build).
set(commit "$ENV{HELIOGRAPH_COMMIT}")
if(NOT commit)
    execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
        OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT commit)
    set(commit unknown)
endif()
string(CONCAT text
    "#include \"api/build_info.h\"\n\n"
    "const api::BuildInfo& api::build_info()\n{\n"
    "    static const BuildInfo info{\"${VERSION}\", \"${commit}\", \"${COMPILER}\", \"${TYPE}\"};\n"
    "    return info;\n}\n")
if(EXISTS ${OUT})
    file(READ ${OUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
    file(WRITE ${OUT} "${text}")
endif()
