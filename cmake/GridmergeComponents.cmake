# The components: the packages that each needs, its rooms in include/gridmerge, and what provides a package on Debian.
# The build reads these lists, and so does the installed package.

# In an order in which each comes after those that it needs.
set(GRIDMERGE_COMPONENTS core merge online io cache bag simulate evaluate report dds)

set(gridmerge_core_packages TBB Eigen3)
set(gridmerge_merge_packages Ceres)
set(gridmerge_online_packages Threads)
set(gridmerge_io_packages yaml-cpp PNG JPEG fmt)
set(gridmerge_cache_packages fmt)
set(gridmerge_bag_packages yaml-cpp SQLite3 lz4 zstd ZLIB fmt)
set(gridmerge_simulate_packages)
set(gridmerge_evaluate_packages nlohmann_json fmt)
set(gridmerge_report_packages nlohmann_json fmt ZLIB)
set(gridmerge_dds_packages CycloneDDS fmt)

# The oldest that will do, where that matters.
set(gridmerge_version_Eigen3 3.3)

# Folders of include/gridmerge.
set(gridmerge_core_rooms grid similarity search match)
set(gridmerge_merge_rooms merge)
set(gridmerge_online_rooms online)
set(gridmerge_io_rooms io)
set(gridmerge_cache_rooms cache)
set(gridmerge_bag_rooms bag)
set(gridmerge_simulate_rooms simulate)
set(gridmerge_evaluate_rooms evaluate)
set(gridmerge_report_rooms report)
set(gridmerge_dds_rooms dds)

# Of gridmerge itself, all that a component needs.
set(gridmerge_core_needs)
set(gridmerge_merge_needs core)
set(gridmerge_online_needs core merge)
set(gridmerge_io_needs core)
set(gridmerge_cache_needs core merge io)
set(gridmerge_bag_needs core io)
set(gridmerge_simulate_needs core)
set(gridmerge_evaluate_needs core merge io bag simulate)
set(gridmerge_report_needs core merge io)
set(gridmerge_dds_needs core merge online)

set(gridmerge_debian_TBB libtbb-dev)
set(gridmerge_debian_Eigen3 libeigen3-dev)
set(gridmerge_debian_Ceres libceres-dev)
set(gridmerge_debian_Threads libc6-dev)
set(gridmerge_debian_yaml-cpp libyaml-cpp-dev)
set(gridmerge_debian_PNG libpng-dev)
set(gridmerge_debian_JPEG libjpeg-dev)
set(gridmerge_debian_ZLIB zlib1g-dev)
set(gridmerge_debian_SQLite3 libsqlite3-dev)
set(gridmerge_debian_lz4 liblz4-dev)
set(gridmerge_debian_zstd libzstd-dev)
set(gridmerge_debian_nlohmann_json nlohmann-json3-dev)
set(gridmerge_debian_fmt libfmt-dev)
set(gridmerge_debian_CycloneDDS cyclonedds-dev)

# How pkg-config's users link a package that a static library needs.
set(gridmerge_link_TBB -ltbb)
set(gridmerge_link_Ceres "-lceres -lglog")
set(gridmerge_link_Threads -pthread)
set(gridmerge_link_yaml-cpp -lyaml-cpp)
set(gridmerge_link_PNG -lpng)
set(gridmerge_link_JPEG -ljpeg)
set(gridmerge_link_ZLIB -lz)
set(gridmerge_link_SQLite3 -lsqlite3)
set(gridmerge_link_lz4 -llz4)
set(gridmerge_link_zstd -lzstd)
set(gridmerge_link_fmt -lfmt)
set(gridmerge_link_CycloneDDS -lddsc)
