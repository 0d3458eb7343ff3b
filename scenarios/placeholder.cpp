namespace vsslam {}
