# SPDX-License-Identifier: MIT
# The core as one file, rlvc.c, which compiles in half the time: for tests of what does not depend on how the sources are
# divided. Sets RLVC_AMALGAMATION to its name; whoever compiles it in another directory depends on the target amalgamation.
find_program(RLVC_PYTHON NAMES python3 HINTS /usr/bin DOC "A Python 3" REQUIRED) # as in tests/
set(RLVC_AMALGAMATION ${PROJECT_BINARY_DIR}/amalgamation/rlvc.c)
if(NOT TARGET amalgamation)
    file(GLOB_RECURSE amalgamated CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/*.[ch])
    add_custom_command(OUTPUT ${RLVC_AMALGAMATION}
        COMMAND ${RLVC_PYTHON} -B ${PROJECT_SOURCE_DIR}/tools/packages/amalgamate.py
                ${PROJECT_BINARY_DIR}/amalgamation
        DEPENDS ${amalgamated} ${PROJECT_SOURCE_DIR}/tools/packages/amalgamate.py
                ${PROJECT_SOURCE_DIR}/tools/check/sources.py VERBATIM)
    add_custom_target(amalgamation DEPENDS ${RLVC_AMALGAMATION})
endif()
