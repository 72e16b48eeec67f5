// Empty: for the headers that CMakeLists.txt has precompiled for all test programs.
