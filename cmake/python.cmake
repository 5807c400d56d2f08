# The Python module `graze`: its compiled part beside links to its sources, so that PYTHONPATH=build/.../python uses it.
# The shared HDF5 library is used, since the archive is not compiled for shared objects.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
# CMake would take the headers of any Python of this version that it finds first.
execute_process(
    COMMAND ${Python3_EXECUTABLE} -c "import sysconfig; print(sysconfig.get_path('include'))"
    OUTPUT_VARIABLE Python3_INCLUDE_DIR OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY
)
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
set(PYTHON_EXECUTABLE ${Python3_EXECUTABLE})
find_package(pybind11 2.10 REQUIRED)

file(GLOB python_bindings CONFIGURE_DEPENDS src/python/*.cpp)
set(library_objects)
foreach(folder IN LISTS GRAZE_FOLDERS)
    list(APPEND library_objects $<TARGET_OBJECTS:graze_${folder}>)
endforeach()
list(APPEND library_objects $<TARGET_OBJECTS:graze_kernels>)
pybind11_add_module(graze_python MODULE NO_EXTRAS ${python_bindings} ${library_objects})
set_target_properties(graze_python PROPERTIES OUTPUT_NAME _graze LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/graze)
target_include_directories(graze_python PRIVATE include src)
target_link_libraries(graze_python PRIVATE graze_instrument graze_options ${GRAZE_LINKED} hdf5::hdf5 graze_httplib)
target_compile_options(graze_python PRIVATE ${GRAZE_COMPILED_FAST})
# Calls within the module go straight to their functions, as in the program: a tenth of the time of sweeps.
target_link_options(graze_python PRIVATE -Wl,-Bsymbolic-functions)
compile_together(graze_python 9 ${python_bindings})
target_compile_definitions(graze_python PRIVATE GRAZE_VERSION="${PROJECT_VERSION}")

file(GLOB python_sources CONFIGURE_DEPENDS python/graze/*.py python/graze/*.pyi python/graze/py.typed)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/python/graze)
foreach(source IN LISTS python_sources)
    get_filename_component(name ${source} NAME)
    file(CREATE_LINK ${source} ${PROJECT_BINARY_DIR}/python/graze/${name} SYMBOLIC)
endforeach()

# Of the Debian package python3-graze only: `cmake --install BUILD --component python`.
if(GRAZE_INSTALL)
    set(python_folder lib/python3/dist-packages/graze)
    install(TARGETS graze_python LIBRARY DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL)
    install(FILES ${python_sources} DESTINATION ${python_folder} COMPONENT python EXCLUDE_FROM_ALL)
endif()
