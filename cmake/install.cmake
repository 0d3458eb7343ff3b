# The estimator as a library for others: find_package(vsslam), target vsslam::slam.
