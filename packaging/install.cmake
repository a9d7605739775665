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

# The same pages for a browser, where mkdocs is there to make them. Their pictures are those beside the text.
find_program(MKDOCS mkdocs)
set(html ${PROJECT_BINARY_DIR}/manual/html)
if(MKDOCS)
  install(CODE "execute_process(COMMAND \"${PROJECT_SOURCE_DIR}/tools/scripts/checks/manual.sh\" \"${html}\" COMMAND_ERROR_IS_FATAL ANY)
    file(REMOVE_RECURSE \"${html}/pictures\" \"${html}/sitemap.xml\" \"${html}/sitemap.xml.gz\")
    file(CREATE_LINK ../pictures \"${html}/pictures\" SYMBOLIC)" COMPONENT program)
  install(DIRECTORY ${html} DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
else()
  message(STATUS "mkdocs is not installed: the manual will be installed as text, without HTML")
endif()

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
