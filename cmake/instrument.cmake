# Simulated instruments, for `graze bench` and for tests: a library of its own, which the main library does not need and
# which is not installed. It is not linked with the main library here, because tests are linked with parts of that.
file(GLOB instrument_sources CONFIGURE_DEPENDS src/instrument/*.cpp)
add_library(graze_instrument STATIC ${instrument_sources})
set_target_properties(graze_instrument PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_include_directories(graze_instrument PUBLIC include src)
target_link_libraries(graze_instrument PUBLIC fmt::fmt PRIVATE graze_options graze_headers)
target_compile_options(graze_instrument PRIVATE ${GRAZE_COMPILED_FAST})
use_prefix(graze_instrument graze_prefix_fast)
compile_together(graze_instrument 12 ${instrument_sources})
