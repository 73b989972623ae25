# Debian's interpreter is the one that sees Debian's matplotlib.
find_program(CAUSTICS_SYSTEM_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
add_test(NAME tooling.plots COMMAND "${CAUSTICS_SYSTEM_PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/plots_test.py")
set_tests_properties(tooling.plots PROPERTIES LABELS cli)
