# caustics::build_info: the header build_info.h, which says what this program was made of.
#
# The header is looked at on every build (the commit moves without CMake noticing) and rewritten only
# when its content changes. Only experiments may include it: core and the methods know no provenance.

string(TOUPPER "${CMAKE_BUILD_TYPE}" caustics_build_type)
string(JOIN " " CAUSTICS_ALL_FLAGS ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${caustics_build_type}}
    ${CAUSTICS_COMPILE_OPTIONS})
set(CAUSTICS_BUILD_INFO_HEADER "${PROJECT_BINARY_DIR}/generated/build_info.h")

add_custom_target(caustics_build_info_header
    COMMAND "${CMAKE_COMMAND}"
        "-DSOURCE_DIR=${PROJECT_SOURCE_DIR}"
        "-DTEMPLATE=${PROJECT_SOURCE_DIR}/cmake/build_info.h.in"
        "-DOUTPUT=${CAUSTICS_BUILD_INFO_HEADER}"
        "-DPROJECT_VERSION=${PROJECT_VERSION}"
        "-DCOMPILER=${CMAKE_CXX_COMPILER_ID}"
        "-DCOMPILER_VERSION=${CMAKE_CXX_COMPILER_VERSION}"
        "-DFLAGS=${CAUSTICS_ALL_FLAGS}"
        "-DBUILD_TYPE=${CMAKE_BUILD_TYPE}"
        "-DEMBREE_VERSION=${embree_VERSION}"
        "-DTBB_VERSION=${TBB_VERSION}"
        "-DOPENEXR_VERSION=${OpenEXR_VERSION}"
        "-DLIBPNG_VERSION=${PNG_VERSION_STRING}"
        "-DOPENIMAGEIO_VERSION=${OpenImageIO_VERSION}"
        "-DEIGEN_VERSION=${Eigen3_VERSION}"
        "-DNLOHMANN_JSON_VERSION=${nlohmann_json_VERSION}"
        -P "${PROJECT_SOURCE_DIR}/cmake/write_build_info.cmake"
    BYPRODUCTS "${CAUSTICS_BUILD_INFO_HEADER}"
    COMMENT "Looking at the commit for build_info.h"
    VERBATIM)

add_library(caustics_build_info INTERFACE)
add_library(caustics::build_info ALIAS caustics_build_info)
target_include_directories(caustics_build_info INTERFACE "${PROJECT_BINARY_DIR}/generated")
add_dependencies(caustics_build_info caustics_build_info_header)
