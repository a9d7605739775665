# cmake -DROOT=sources -DCOPY=folder -DPATCH=file.patch -DPROGRAM=patch -P apply.cmake
# Copies the files that a patch changes, and applies it to the copies. The sources stay as they are.
file(REMOVE_RECURSE ${COPY})
file(MAKE_DIRECTORY ${COPY})
file(STRINGS ${PATCH} changed REGEX "^--- a/")
foreach(line IN LISTS changed)
  string(REGEX REPLACE "^--- a/" "" name "${line}")
  configure_file(${ROOT}/${name} ${COPY}/${name} COPYONLY)
endforeach()
execute_process(COMMAND ${PROGRAM} --batch --silent --fuzz=0 -p1 -d ${COPY} -i ${PATCH} COMMAND_ERROR_IS_FATAL ANY)
