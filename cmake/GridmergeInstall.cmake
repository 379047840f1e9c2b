# install() rules: headers, libraries, the package files for find_package(gridmerge).
