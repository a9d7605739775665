# Installs the build BUILD into an empty folder WORK, compiles the programs beside this file against it, and runs them.
# ctest -L package
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/bounce -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${WORK}/installed -DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF
  COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${WORK}/bounce/CMakeCache.txt found REGEX "^talus_DIR")
if(NOT found MATCHES "${WORK}/installed")
  message(FATAL_ERROR "another Talus was found: ${found}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/bounce COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/bounce/bounce COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/bounce/gully COMMAND_ERROR_IS_FATAL ANY)
