# Links HDF5 as a static library where it and its dependencies are installed: Debian's shared library loads some thirty
# others, for network access, each time the program starts. The archive's network code is not linked, since nothing uses
# it. A shared libgraze cannot contain the archive, which is not compiled as position-independent code.
find_package(HDF5 REQUIRED COMPONENTS C)
add_library(graze_hdf5 INTERFACE)
target_include_directories(graze_hdf5 SYSTEM INTERFACE $<TARGET_PROPERTY:hdf5::hdf5,INTERFACE_INCLUDE_DIRECTORIES>)
target_compile_definitions(graze_hdf5 INTERFACE $<TARGET_PROPERTY:hdf5::hdf5,INTERFACE_COMPILE_DEFINITIONS>)
find_library(GRAZE_HDF5_ARCHIVE libhdf5_serial.a)
find_library(GRAZE_SZIP sz)
find_library(GRAZE_ZLIB z)
mark_as_advanced(GRAZE_HDF5_ARCHIVE GRAZE_SZIP GRAZE_ZLIB)
if(GRAZE_HDF5_ARCHIVE AND GRAZE_SZIP AND GRAZE_ZLIB AND NOT BUILD_SHARED_LIBS)
    target_link_libraries(
        graze_hdf5 INTERFACE ${GRAZE_HDF5_ARCHIVE} ${GRAZE_SZIP} ${GRAZE_ZLIB} Threads::Threads ${CMAKE_DL_LIBS} m
    )
else()
    target_link_libraries(graze_hdf5 INTERFACE hdf5::hdf5)
endif()
