# The library for other programs, find_package(talus): the engine (terrain and physics), which needs Eigen alone. Scenario
# files, tallies and maps are the work of the program `talus`. docs/library.md
set(public_headers talus.hpp
  base/elementary.hpp base/expect.hpp base/lane.hpp base/not_set.hpp base/random.hpp base/scratch.hpp base/shared_memory.hpp base/vector.hpp base/version.hpp
  terrain/grid.hpp terrain/raster.hpp terrain/surface.hpp
  physics/barriers.hpp physics/block.hpp physics/ground.hpp physics/impact.hpp physics/line_piece.hpp physics/path.hpp physics/trace.hpp
  physics/world.hpp)
list(TRANSFORM public_headers PREPEND ${PROJECT_SOURCE_DIR}/include/talus/)

# Objects that the other libraries hold already: nothing is compiled twice. (An object is of a file, or of a folder.)
set(engine_objects "$<FILTER:$<TARGET_OBJECTS:talus_core>,INCLUDE,[/_]src[/_](base|terrain|physics)[/_]>")
foreach(lanes 4 8)
  if(TARGET talus_lanes_${lanes})
    list(APPEND engine_objects $<TARGET_OBJECTS:talus_lanes_${lanes}>)
  endif()
endforeach()
add_library(talus_library STATIC ${engine_objects})
set_target_properties(talus_library PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME talus EXPORT_NAME talus)
add_library(talus::talus ALIAS talus_library)
target_sources(talus_library PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${public_headers})
target_compile_features(talus_library INTERFACE cxx_std_20)
target_compile_options(talus_library INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)  # the same bits as the program
target_link_libraries(talus_library INTERFACE Eigen3::Eigen)
add_dependencies(talus talus_library)  # a moment's work; so an installation after `--target talus` is complete

include(CMakePackageConfigHelpers)
set(talus_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/talus)
configure_package_config_file(packaging/talus-config.cmake.in ${PROJECT_BINARY_DIR}/talus-config.cmake
  INSTALL_DESTINATION ${talus_cmake_folder} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/talus-config-version.cmake COMPATIBILITY SameMinorVersion)
install(TARGETS talus_library EXPORT talus COMPONENT dev ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(EXPORT talus NAMESPACE talus:: FILE talus-targets.cmake DESTINATION ${talus_cmake_folder} COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/talus-config.cmake ${PROJECT_BINARY_DIR}/talus-config-version.cmake
  DESTINATION ${talus_cmake_folder} COMPONENT dev)
