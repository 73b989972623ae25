# Finds what the project stands on. All are imported targets, whose headers CMake treats as SYSTEM.

# Embree 3 and 4 both offer the target `embree`; their differences live in core/scene/intersector.cpp.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
    find_package(embree 3.13 CONFIG REQUIRED)
endif()

find_package(TBB CONFIG REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(nlohmann_json 3.11 CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(OpenImageIO CONFIG REQUIRED)
if(CAUSTICS_TESTS)
    find_package(GTest CONFIG REQUIRED)
endif()
if(CAUSTICS_BENCH)
    find_package(benchmark 1.7 CONFIG REQUIRED)
    find_package(nanoflann 1.4 CONFIG REQUIRED)
endif()

# Debian's OpenImageIO target names /usr/include/opencv4, which no header used here needs and which
# exists only with OpenCV's development package; CMake refuses an include folder that is not there.
function(caustics_drop_missing_includes target)
    foreach(property IN ITEMS INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
        get_target_property(folders ${target} ${property})
        set(present "")
        foreach(folder IN LISTS folders)
            if(EXISTS "${folder}")
                list(APPEND present "${folder}")
            endif()
        endforeach()
        set_target_properties(${target} PROPERTIES ${property} "${present}")
    endforeach()
endfunction()
caustics_drop_missing_includes(OpenImageIO::OpenImageIO)

if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(CAUSTICS_CCACHE ccache)
    mark_as_advanced(CAUSTICS_CCACHE)
    if(CAUSTICS_CCACHE)
        # ccache keeps nothing of a file that reads precompiled headers unless told it may.
        set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
            CCACHE_SLOPPINESS=pch_defines,time_macros "${CAUSTICS_CCACHE}")
        add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
    endif()
endif()
