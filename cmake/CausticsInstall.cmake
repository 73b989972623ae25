# cmake --install: the program and its helpers, the scenes, sweep files and kept references, and the tool behind `report`,
# which find each other by their places. The libraries are not installed: their interfaces are not promised to stay.

install(TARGETS causticbench RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
install(TARGETS read_pictures read_foreign_pictures RUNTIME DESTINATION "${CAUSTICS_HELPER_FOLDER}")
foreach(folder IN ITEMS scenes sweeps references)
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/experiments/${folder}"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/causticbench")
endforeach()
install(DIRECTORY "${PROJECT_SOURCE_DIR}/tools/report" "${PROJECT_SOURCE_DIR}/tools/report_page"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/causticbench/tools" PATTERN "__pycache__" EXCLUDE)
install(PROGRAMS "${PROJECT_SOURCE_DIR}/tools/make_report.py"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/causticbench/tools")
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/THIRD-PARTY.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
