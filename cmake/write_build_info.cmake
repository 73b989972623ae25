# Run with `cmake -P` by the target caustics_build_info_header: fills in build_info.h.in.

set(GIT_COMMIT "unknown")
set(GIT_DIRTY "false")
find_program(GIT git)
# A .git in the project's own root: a copy unpacked inside another repository must not take that
# repository's commit for its own.
if(GIT AND EXISTS "${SOURCE_DIR}/.git")
    execute_process(COMMAND "${GIT}" -C "${SOURCE_DIR}" rev-parse --short=12 HEAD
        OUTPUT_VARIABLE commit RESULT_VARIABLE failed
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(NOT failed)
        set(GIT_COMMIT "${commit}")
        execute_process(
            COMMAND "${GIT}" -C "${SOURCE_DIR}" status --porcelain --untracked-files=no
            OUTPUT_VARIABLE changes OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
        if(changes)
            set(GIT_DIRTY "true")
        endif()
    endif()
endif()
configure_file("${TEMPLATE}" "${OUTPUT}" @ONLY)
