# What `cmake --install` puts where. Components: program (the Debian package talus), mpi (talus-mpi), dev (libtalus-dev,
# in library.cmake).
install(TARGETS talus RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
if(TARGET talus-mpi)
  install(TARGETS talus-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mpi OPTIONAL)
  install(FILES packaging/talus-mpi.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT mpi)
endif()

install(FILES README.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY data/valley data/elm data/profile DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program)

# QGIS looks for plug-ins of the system in /usr/share only.
install(DIRECTORY tools/qgis/talus_qgis DESTINATION ${CMAKE_INSTALL_DATADIR}/qgis/python/plugins COMPONENT program OPTIONAL
  PATTERN __pycache__ EXCLUDE)

# Manual pages and completions follow from the program that was built. They are made here, not in an ordinary build.
set(manual ${PROJECT_BINARY_DIR}/manual/talus)
install(CODE "execute_process(COMMAND /usr/bin/env python3 \"${PROJECT_SOURCE_DIR}/tools/scripts/package/make_manual.py\"
  --program \"$<TARGET_FILE:talus>\" --out \"${manual}\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(DIRECTORY ${manual}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(DIRECTORY ${manual}/zsh/ DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(DIRECTORY ${manual}/fish/ DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
