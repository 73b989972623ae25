# caustics_library, caustics_executable and caustics_test: one way to make a target.
#
# An item of DEPENDS or PRIVATE_DEPENDS is a folder's library (`core`, meaning caustics::core) or any
# target that exists already (`embree`, `Eigen3::Eigen`). Sources are listed one by one.

include(GoogleTest)

set(CAUSTICS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # It sees uninitialised members in std::variant's move at -O2 and -O3 (its bug 80635).
    list(APPEND CAUSTICS_WARNINGS -Wno-maybe-uninitialized)
    # GCC 12 sees overlapping copies in std::string's operator+ at -O3 (its bug 105651).
    list(APPEND CAUSTICS_WARNINGS -Wno-restrict)
    # In a batch it takes source files for headers, whose types may have no member of a file's own type.
    if(CAUSTICS_BATCHES)
        list(APPEND CAUSTICS_WARNINGS -Wno-subobject-linkage)
    endif()
else()
    # GCC's pragmas say that a loop's arrays do not overlap, which others find out at run time.
    list(APPEND CAUSTICS_WARNINGS -Wno-unknown-pragmas)
    # In a batch it takes a variable for one that hides the constant of a neighbouring file.
    if(CAUSTICS_BATCHES)
        list(REMOVE_ITEM CAUSTICS_WARNINGS -Wshadow)
    endif()
endif()
# No fused multiply-add: the same bits from every build of the same source.
set(CAUSTICS_COMPILE_OPTIONS -ffp-contract=off)
set(CAUSTICS_LINK_OPTIONS "")
# Programs read files of strangers: in release, an overrun of a buffer ends the program, and no table of functions
# can be written to.
if(NOT CAUSTICS_SANITIZE)
    list(APPEND CAUSTICS_COMPILE_OPTIONS
        "$<$<CONFIG:Release>:-fstack-protector-strong;-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
    list(APPEND CAUSTICS_LINK_OPTIONS -Wl,-z,relro,-z,now)
endif()
# Kernels in AVX2 and AVX-512 are built wherever the processor's family has them.
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" caustics_processor)
if(caustics_processor MATCHES "^(x86_64|amd64)$")
    set(CAUSTICS_X86_KERNELS ON)
endif()
if(CAUSTICS_SANITIZE)
    list(APPEND CAUSTICS_COMPILE_OPTIONS "-fsanitize=${CAUSTICS_SANITIZE}"
        -fno-omit-frame-pointer -fno-sanitize-recover=all)
    list(APPEND CAUSTICS_LINK_OPTIONS "-fsanitize=${CAUSTICS_SANITIZE}")
endif()
if(CAUSTICS_FUZZ)
    list(APPEND CAUSTICS_COMPILE_OPTIONS -fsanitize=fuzzer-no-link)
endif()
if(CAUSTICS_FUZZ OR CAUSTICS_COVERAGE)
    # Of LLVM: the lines and branches that llvm-cov reports.
    list(APPEND CAUSTICS_COMPILE_OPTIONS -fprofile-instr-generate -fcoverage-mapping)
    list(APPEND CAUSTICS_LINK_OPTIONS -fprofile-instr-generate)
endif()

# The headers of others that most files read, compiled once: parsing them is half of a build's time.
# Our own headers are not among them. `caustics_precompiled` serves libraries and programs,
# `caustics_precompiled_tests` has GoogleTest and fmt as well.
function(caustics_use_precompiled target name)
    if(NOT CAUSTICS_PRECOMPILED_HEADERS)
        return()
    endif()
    if(NOT TARGET ${name})
        set(headers <Eigen/Core> <Eigen/Geometry> <algorithm> <filesystem> <functional> <map>
            <optional> <string> <variant> <vector>)
        set(depends Eigen3::Eigen)
        if(name STREQUAL caustics_precompiled_tests)
            list(APPEND headers <fmt/format.h> <gtest/gtest.h>)
            list(APPEND depends fmt::fmt GTest::gtest)
        endif()
        set(source "${PROJECT_BINARY_DIR}/generated/${name}.cpp")
        file(CONFIGURE OUTPUT "${source}" CONTENT "")
        add_library(${name} OBJECT "${source}")
        caustics_configure_target(${name})
        target_link_libraries(${name} PRIVATE ${depends})
        target_precompile_headers(${name} PRIVATE ${headers})
    endif()
    target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()

# Sets `out` to the targets that the items name.
function(caustics_resolve_targets out)
    set(targets "")
    foreach(item IN LISTS ARGN)
        if(TARGET "caustics_${item}")
            list(APPEND targets "caustics_${item}")
        elseif(TARGET "${item}")
            list(APPEND targets "${item}")
        else()
            message(FATAL_ERROR "${CMAKE_CURRENT_SOURCE_DIR}: no target called '${item}'")
        endif()
    endforeach()
    set(${out} "${targets}" PARENT_SCOPE)
endfunction()

# Language, warnings, instrumentation and include root of one target of ours.
function(caustics_configure_target target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF
        UNITY_BUILD ${CAUSTICS_BATCHES} UNITY_BUILD_BATCH_SIZE 8)
    target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}")
    target_compile_options(${target} PRIVATE ${CAUSTICS_WARNINGS} ${CAUSTICS_COMPILE_OPTIONS})
    target_link_options(${target} PRIVATE ${CAUSTICS_LINK_OPTIONS})
    if(CAUSTICS_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(CAUSTICS_STD_THREADS)
        target_compile_definitions(${target} PRIVATE CAUSTICS_STD_THREADS=1)
    endif()
    if(CAUSTICS_X86_KERNELS)
        target_compile_definitions(${target} PRIVATE CAUSTICS_X86_KERNELS=1)
    endif()
endfunction()

# caustics_library(photonmap SOURCES ... [DEPENDS core ...] [PRIVATE_DEPENDS ...])
# makes the static library caustics_photonmap with the alias caustics::photonmap.
function(caustics_library name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS")
    caustics_resolve_targets(depends ${arg_DEPENDS})
    caustics_resolve_targets(private_depends ${arg_PRIVATE_DEPENDS})
    add_library(caustics_${name} STATIC ${arg_SOURCES})
    add_library(caustics::${name} ALIAS caustics_${name})
    caustics_configure_target(caustics_${name})
    caustics_use_precompiled(caustics_${name} caustics_precompiled)
    target_link_libraries(caustics_${name} PUBLIC ${depends} PRIVATE ${private_depends})
endfunction()

# caustics_isa_sources(photonmap AVX2 a_avx2.cpp ... AVX512 a_avx512.cpp ...) adds sources that are
# compiled for wider registers and chosen at run time (core/base/isa.h). They must include no inline code of
# Eigen or the standard library: the linker could take that code for all of the program.
function(caustics_isa_sources library)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "AVX2;AVX512")
    if(NOT CAUSTICS_X86_KERNELS)
        return()
    endif()
    # GCC 12 sees uninitialised registers in its own intrinsics (its bug 105593).
    set(avx2_flags -mavx2 -mbmi -mbmi2 -mlzcnt -Wno-uninitialized)
    target_sources(caustics_${library} PRIVATE ${arg_AVX2} ${arg_AVX512})
    set_source_files_properties(${arg_AVX2} PROPERTIES
        COMPILE_OPTIONS "${avx2_flags}" SKIP_PRECOMPILE_HEADERS ON)
    set_source_files_properties(${arg_AVX512} PROPERTIES
        COMPILE_OPTIONS "${avx2_flags};-mavx512f;-mavx512bw;-mavx512dq;-mavx512vl"
        SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# caustics_executable(causticbench SOURCES ... DEPENDS ...): the program <build folder>/bin/causticbench.
function(caustics_executable name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
    caustics_resolve_targets(depends ${arg_DEPENDS})
    add_executable(${name} ${arg_SOURCES})
    caustics_configure_target(${name})
    caustics_use_precompiled(${name} caustics_precompiled)
    target_link_libraries(${name} PRIVATE ${depends})
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
    add_dependencies(${name} caustics_helpers)
endfunction()

# caustics_helper(read_pictures SOURCES ... DEPENDS ...): a program that other programs start, from
# ../<CAUSTICS_HELPER_FOLDER> beside their own folder, both where they are built and where they are installed.
include(GNUInstallDirs)
set(CAUSTICS_HELPER_FOLDER "${CMAKE_INSTALL_LIBDIR}/causticbench")
add_custom_target(caustics_helpers)
function(caustics_helper name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
    caustics_resolve_targets(depends ${arg_DEPENDS})
    add_executable(${name} ${arg_SOURCES})
    caustics_configure_target(${name})
    target_link_libraries(${name} PRIVATE ${depends})
    # It starts faster without the libraries of core that it does not call.
    target_link_options(${name} PRIVATE -Wl,--as-needed)
    set_target_properties(${name} PROPERTIES
        RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/${CAUSTICS_HELPER_FOLDER}")
    add_dependencies(caustics_helpers ${name})
endfunction()

# caustics_test(kd_tree SOURCES ... DEPENDS ... LABELS ... [DEFINES ...] [SHARED_MESHES])
#
# Makes one GoogleTest program; each of its tests becomes the ctest `kd_tree.Suite.Name`. The macro
# CAUSTICS_SOURCE_DIR is the project's root, where tests find scenes. With SHARED_MESHES the tests
# also carry the label `shared` and see the macro CAUSTICS_SHARED_DIR; they are left out where that
# folder does not exist (the ctest shared.meshes_present says so). The target `unit_tests` builds those
# labelled `unit`.
function(caustics_test name)
    cmake_parse_arguments(PARSE_ARGV 1 arg "SHARED_MESHES" "TIMEOUT"
        "SOURCES;DEPENDS;LABELS;DEFINES")
    if(NOT arg_LABELS)
        message(FATAL_ERROR "caustics_test(${name}): LABELS is missing "
            "(unit, statistical, agreement, cli, bench-smoke)")
    endif()
    if(NOT arg_TIMEOUT)
        set(arg_TIMEOUT 600)
    endif()
    if(CAUSTICS_SANITIZE)
        math(EXPR arg_TIMEOUT "4 * ${arg_TIMEOUT}")
    endif()
    if(arg_SHARED_MESHES)
        if(NOT IS_DIRECTORY "${CAUSTICS_SHARED_DIR}/meshes")
            return()
        endif()
        list(APPEND arg_LABELS shared)
        list(APPEND arg_DEFINES "CAUSTICS_SHARED_DIR=\"${CAUSTICS_SHARED_DIR}\"")
    endif()
    caustics_resolve_targets(depends ${arg_DEPENDS})
    set(program test_${name})
    add_executable(${program} ${arg_SOURCES})
    caustics_configure_target(${program})
    if(CAUSTICS_BATCHES AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        # A file's constants would be shadowed by its neighbours' variables.
        target_compile_options(${program} PRIVATE -Wno-shadow -Wshadow=local)
    endif()
    caustics_use_precompiled(${program} caustics_precompiled_tests)
    target_link_libraries(${program} PRIVATE ${depends} fmt::fmt GTest::gtest_main)
    target_compile_definitions(${program} PRIVATE
        "CAUSTICS_SOURCE_DIR=\"${PROJECT_SOURCE_DIR}\"" ${arg_DEFINES})
    set_target_properties(${program} PROPERTIES
        RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
    add_dependencies(${program} caustics_helpers)
    if("unit" IN_LIST arg_LABELS)
        add_dependencies(unit_tests ${program})
    endif()
    gtest_discover_tests(${program}
        TEST_PREFIX "${name}."
        TEST_LIST ${program}_tests
        NO_PRETTY_VALUES
        DISCOVERY_TIMEOUT 120
        PROPERTIES TIMEOUT ${arg_TIMEOUT})
    # gtest_discover_tests would split a list of labels, so they are set on what it has found.
    set(labels_file "${CMAKE_CURRENT_BINARY_DIR}/${program}_labels.cmake")
    file(WRITE "${labels_file}"
        "if(${program}_tests)\n"
        "  set_tests_properties(\${${program}_tests} PROPERTIES LABELS \"${arg_LABELS}\")\n"
        "endif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${labels_file}")
endfunction()
