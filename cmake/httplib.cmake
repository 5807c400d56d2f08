# The server of pages uses cpp-httplib. Debian has it as a header and a shared library, other systems as a header alone, which
# then contains everything.
find_path(GRAZE_HTTPLIB_HEADERS httplib.h REQUIRED)
find_library(GRAZE_HTTPLIB cpp-httplib)
mark_as_advanced(GRAZE_HTTPLIB_HEADERS GRAZE_HTTPLIB)
add_library(graze_httplib INTERFACE)
target_include_directories(graze_httplib SYSTEM INTERFACE ${GRAZE_HTTPLIB_HEADERS})
target_link_libraries(graze_httplib INTERFACE Threads::Threads)
if(GRAZE_HTTPLIB)
    # Its classes have members that depend on these, with which Debian compiles it.
    target_compile_definitions(
        graze_httplib INTERFACE CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT
    )
    target_link_libraries(graze_httplib INTERFACE ${GRAZE_HTTPLIB})
endif()
