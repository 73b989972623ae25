# cmake --install: the program, and the scenes, sweep files and kept references, which find each other by
# their places. The libraries are not installed: their interfaces are not promised to stay.

include(GNUInstallDirs)

install(TARGETS causticbench RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
foreach(folder IN ITEMS scenes sweeps references)
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/experiments/${folder}"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/causticbench")
endforeach()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
