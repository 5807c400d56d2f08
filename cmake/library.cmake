# The folders of the library, in the order of the architecture; each may use only those before it. Each is compiled once,
# as an object library. The library consists of all of them; the tests of a folder are linked with it and those before it.
set(GRAZE_FOLDERS base symbolic model tape flow trajectory record bench acquire identify sweep orbit grazing branch trip results study atlas design layout picture page)

# Other libraries that a folder needs.
if(GRAZE_NATIVE)
    # Without its definitions, which all users of the folder would have, but not their precompiled headers.
    set(GRAZE_NEEDS_tape $<TARGET_FILE:asmjit::asmjit>)
endif()
set(GRAZE_NEEDS_sweep Threads::Threads)
set(GRAZE_NEEDS_record graze_hdf5)
set(GRAZE_NEEDS_acquire Boost::headers Threads::Threads)
set(GRAZE_NEEDS_results SQLite::SQLite3 graze_hdf5)
set(GRAZE_NEEDS_identify Ceres::ceres)
set(GRAZE_NEEDS_design NLopt::nlopt)
set(GRAZE_NEEDS_page nlohmann_json::nlohmann_json graze_httplib Threads::Threads)

# Folders that compute for long enough to be worth optimising; the others are compiled fast. Under the thread sanitizer
# tests are few and short, and fewer folders are optimised.
set(computing base tape flow trajectory sweep)
if(NOT GRAZE_SANITIZERS STREQUAL "thread")
    list(APPEND computing symbolic identify orbit branch trip)
endif()
if(NOT GRAZE_SANITIZERS)
    list(APPEND computing record)
elseif(NOT GRAZE_SANITIZERS STREQUAL "thread") # fast-compiled folders are then not optimised at all
    list(APPEND computing grazing design)
endif()

include(cmake/kernels.cmake)
add_library(graze)
add_library(graze::graze ALIAS graze)
set(earlier)
foreach(folder IN LISTS GRAZE_FOLDERS)
    file(GLOB sources CONFIGURE_DEPENDS src/${folder}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/tape/jet_(baseline|avx2|avx512).cpp$")
    if(NOT GRAZE_NATIVE)
        list(FILTER sources EXCLUDE REGEX "/tape/native_(emitter|registers|sums).cpp$")
    endif()
    if(sources)
        add_library(graze_${folder} OBJECT ${sources})
        set_target_properties(graze_${folder} PROPERTIES POSITION_INDEPENDENT_CODE ON)
        target_include_directories(graze_${folder} PUBLIC include PRIVATE src)
        target_link_libraries(graze_${folder} PUBLIC fmt::fmt PRIVATE graze_options graze_headers)
        target_link_libraries(graze_${folder} PUBLIC ${GRAZE_NEEDS_${folder}})
        set(together ${sources})
        if(folder IN_LIST computing)
            target_compile_options(graze_${folder} PRIVATE ${GRAZE_COMPILED_COMPUTING})
            use_prefix(graze_${folder} graze_prefix_computing)
            set(most 12)
            # Its instances of Eigen's templates take longer to compile than all else here.
            list(FILTER together EXCLUDE REGEX "/decompositions.cpp$")
            list(FILTER together EXCLUDE REGEX "/native_[a-z]+.cpp$")
        else()
            target_compile_options(graze_${folder} PRIVATE ${GRAZE_COMPILED_FAST})
            use_prefix(graze_${folder} graze_prefix_fast)
            set(most 24)
        endif()
        compile_together(graze_${folder} ${most} ${together})
        target_sources(graze PRIVATE $<TARGET_OBJECTS:graze_${folder}>)
        list(APPEND earlier ${folder})
    endif()
    set(before_${folder} ${earlier})
endforeach()
target_compile_definitions(graze_tape PRIVATE ${kernel_definitions})
# What is linked with the folder of the kernels is linked with these as well.
target_sources(graze_tape INTERFACE $<TARGET_OBJECTS:graze_kernels>)
target_sources(graze PRIVATE $<TARGET_OBJECTS:graze_kernels>)
include(cmake/catalogue.cmake OPTIONAL)
include(cmake/page.cmake OPTIONAL)

target_compile_features(graze PUBLIC cxx_std_20)
target_include_directories(
    graze PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
)
# All but HDF5, of which the Python module uses another form, and cpp-httplib, which only the server of pages needs.
set(GRAZE_LINKED fmt::fmt Threads::Threads SQLite::SQLite3 NLopt::nlopt Ceres::ceres)
if(GRAZE_NATIVE)
    list(APPEND GRAZE_LINKED asmjit::asmjit)
endif()
target_link_libraries(graze PRIVATE $<BUILD_INTERFACE:graze_options> ${GRAZE_LINKED} $<BUILD_INTERFACE:graze_hdf5>
                                    $<BUILD_INTERFACE:graze_httplib>
)
set_target_properties(
    graze PROPERTIES LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION
                     ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
)
if(GRAZE_NATIVE)
    target_compile_definitions(
        graze_tape PRIVATE GRAZE_NATIVE $<TARGET_PROPERTY:asmjit::asmjit,INTERFACE_COMPILE_DEFINITIONS>
    )
endif()
foreach(folder study page)
    target_compile_definitions(graze_${folder} PRIVATE GRAZE_VERSION="${PROJECT_VERSION}")
endforeach()
