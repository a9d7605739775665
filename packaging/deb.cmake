# Debian packages, by cpack after a build: talus, talus-mpi, libtalus-dev. tools/scripts/checks/package.sh makes and tries
# them. docs/install.md, docs/releasing.md
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # a package needs the programs, not all tests

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_VENDOR "The Talus authors")
set(CPACK_PACKAGE_CONTACT "The Talus authors <talus@example.org>")  # placeholder: docs/releasing.md
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
  WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS OFF)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME talus)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "proj-data")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "qgis (>= 3.22), python3-qgis, talus-mpi, libtalus-dev")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "rock-fall hazard on 3D terrain
Talus lets many blocks fall from source areas over a digital terrain model,
with the stochastic impact model of PIERRE 2, and maps for each cell how many
come through, how fast, how high and with how much energy. From that follow
annual frequencies, return periods, classes of hazard and design values of
barriers. Terrain and layers are read by GDAL; results open in QGIS.

This package has the program, its manual, the examples of the manual,
completions of bash, zsh and fish, and the plug-in of QGIS (Processing provider
Talus).")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libtalus-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_DEV_DESCRIPTION "rock-fall trajectories on 3D terrain - C++ library
The engine of Talus for other programs: a terrain of bilinear patches, the
stochastic impact law of PIERRE 2, and the trajectories of single blocks, with
the same bits as those of the program talus.

This package has the static library, its headers and the files for CMake
(find_package(talus), target talus::talus).")

if(TARGET talus-mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME talus-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "talus (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)
  set(CPACK_COMPONENT_MPI_DESCRIPTION "rock-fall hazard on 3D terrain - runs over many machines
Talus lets many blocks fall from source areas over a digital terrain model,
and maps how many come through each cell, how fast, how high and with how much
energy.

This package has talus-mpi, which spreads a run over the processes of mpirun.
Its results have the same bits as those of talus.")
endif()

set(CPACK_PROJECT_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/packaging/debian/papers.cmake)
include(CPack)
