#include "study/scratch_folder.hpp"

#include "graze/base/input_error.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

namespace graze {

ScratchFolder::ScratchFolder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string name = ((error ? std::filesystem::path("/tmp") : parent) / "graze-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
        throw FileError(name, "a folder for temporary files cannot be made",
                        "let TMPDIR name a folder that can be written");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code error; // what remains is temporary anyway
    std::filesystem::remove_all(path_, error);
}

void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream stream(path, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream)
        throw FileError(path, "the file cannot be written", "make room there, or let TMPDIR name another folder");
}

std::string bytes_in(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad() || !stream.is_open())
        throw FileError(path, "the file cannot be read", "run the study again");
    return bytes;
}

} // namespace graze
