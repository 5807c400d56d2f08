// For any bytes, reading a model either succeeds or throws an InputError; a model that was read can be written and read
// again.

#include "graze/base/input_error.hpp"
#include "graze/model/check.hpp"
#include "graze/model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace {

std::optional<graze::Model> read(std::string_view text) {
    try {
        return graze::parse_model(text, "fuzz.toml");
    } catch (const graze::InputError&) {
        return std::nullopt;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto model = read({reinterpret_cast<const char*>(data), size});
    if (model) {
        graze::model_warnings(*model);
        graze::connectivity_graph(*model);
        graze::parse_model(graze::write_model(*model), "written.toml"); // an error here is not caught: it is a finding
    }
    return 0;
}
