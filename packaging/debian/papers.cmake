# Adds to each package the papers that Debian asks for, licence and changes, and compresses its manual pages. Run by
# cpack between installing and packing.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(folder ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  execute_process(COMMAND /usr/bin/env python3 ${CPACK_PROJECT_SOURCE}/tools/scripts/package/make_papers.py
    --changes ${CPACK_PROJECT_SOURCE}/CHANGELOG.md --version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}
    --contact ${CPACK_PACKAGE_CONTACT} --out ${folder} COMMAND_ERROR_IS_FATAL ANY)
  file(COPY ${CPACK_PROJECT_SOURCE}/packaging/debian/copyright DESTINATION ${folder})
  file(GLOB pages ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share/man/man1/*.1)
  if(pages)
    execute_process(COMMAND gzip --best --no-name ${pages} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
