# The estimator as a library for others: find_package(vsslam), target vsslam::slam. Headers are included as here:
# #include "slam/slam.h". The flags travel with the target: Eigen's alignment and the instruction set are part
# of the binary interface.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(VSSLAM_INCLUDE_DIR ${CMAKE_INSTALL_INCLUDEDIR}/vsslam)
set(VSSLAM_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vsslam)
target_include_directories(vsslam_flags INTERFACE $<INSTALL_INTERFACE:${VSSLAM_INCLUDE_DIR}>)
target_compile_features(vsslam_flags INTERFACE cxx_std_20)
set_target_properties(vsslam_core PROPERTIES EXPORT_NAME core)
set_target_properties(vsslam_slam PROPERTIES EXPORT_NAME slam)
set_target_properties(vsslam_flags PROPERTIES EXPORT_NAME flags)
set_target_properties(vsslam_strict PROPERTIES EXPORT_NAME strict)
set_target_properties(vsslam_pcl PROPERTIES EXPORT_NAME pcl)
set_target_properties(vsslam_opencv PROPERTIES EXPORT_NAME opencv)

install(TARGETS vsslam_slam vsslam_core vsslam_flags vsslam_strict vsslam_pcl
                vsslam_opencv EXPORT vsslamTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY core slam DESTINATION ${VSSLAM_INCLUDE_DIR} FILES_MATCHING PATTERN "*.h")
install(EXPORT vsslamTargets NAMESPACE vsslam:: DESTINATION ${VSSLAM_PACKAGE_DIR})
configure_package_config_file(cmake/vsslamConfig.cmake.in ${CMAKE_BINARY_DIR}/vsslamConfig.cmake
                              INSTALL_DESTINATION ${VSSLAM_PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/vsslamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/vsslamConfig.cmake ${CMAKE_BINARY_DIR}/vsslamConfigVersion.cmake
        DESTINATION ${VSSLAM_PACKAGE_DIR})
