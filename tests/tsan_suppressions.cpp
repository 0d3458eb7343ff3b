// What the thread sanitizer reports of libraries that are not ours. Compiled in, because programs also run where no
// environment tells them: when CMake asks them for their tests.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\n";  // comes with pcl_io; unlocks, as it is loaded, a mutex that it has not locked
}
