# The Debian package: `cpack` in the build folder makes it from the installed files.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME graze)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# The permissions that dpkg expects, whatever the umask of the user who makes the package.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE
)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# A package must name a maintainer; a distributor sets it with `cpack -D CPACK_DEBIAN_PACKAGE_MAINTAINER="A <a@b.c>"`.
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "the graze authors <graze@localhost>")
string(
    CONCAT
        CPACK_DEBIAN_PACKAGE_DESCRIPTION
        "Simulates motions with impacts, switches, sticking and chatter, sweeps parameters, draws\n"
        "basins of attraction, finds periodic orbits, stable or not, and follows them along parameters\n"
        "through their bifurcations and grazings. The program graze, a C++ library, models and studies\n"
        "of the literature."
)
# Dependencies on libraries are found from those to which the program is linked. The programs that draw, and the packages for
# linking with the library, must be listed.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot, graphviz")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libfmt-dev, libsqlite3-dev, libnlopt-dev, libceres-dev, libcpp-httplib-dev, libasmjit-dev")
include(CPack)

# The Python module is a package of its own: `cpack --config CPackPythonConfig.cmake`.
if(GRAZE_PYTHON)
    math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
    file(
        CONFIGURE OUTPUT CPackPythonConfig.cmake @ONLY
        CONTENT [[
include("@PROJECT_BINARY_DIR@/CPackConfig.cmake")
set(CPACK_PACKAGE_NAME python3-graze)
set(CPACK_DEBIAN_PACKAGE_NAME python3-graze)
set(CPACK_DEBIAN_PACKAGE_SECTION python)
set(CPACK_INSTALL_CMAKE_PROJECTS "@PROJECT_BINARY_DIR@;graze;python;/")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= @Python3_VERSION_MAJOR@.@Python3_VERSION_MINOR@), python3 (<< @Python3_VERSION_MAJOR@.@next_minor@), python3-numpy (>= 1:1.24)")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-pandas, python3-xarray, python3-tqdm, python3-distributed, python3-mpi4py, graze")
string(REGEX REPLACE "The program.*" "The module graze of Python 3, with models and studies of the literature."
                     CPACK_DEBIAN_PACKAGE_DESCRIPTION "${CPACK_DEBIAN_PACKAGE_DESCRIPTION}")
]]
    )
endif()
