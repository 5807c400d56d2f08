#include "instrument/terminal.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <termios.h>
#include <utility>

namespace graze {

namespace {

/// Frees the name if it is a stale link to a terminal; any other file is kept.
void clear_name(const std::string& name) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::symlink_status(name, error);
    if (!std::filesystem::exists(status))
        return;
    const std::string target =
        std::filesystem::is_symlink(status) ? std::filesystem::read_symlink(name, error).string() : std::string();
    if (!target.starts_with("/dev/pts/"))
        throw InputError(Place{"port", 0, 0}, fmt::format("'{}' exists already", name), "choose another name");
    if (std::filesystem::exists(target, error))
        throw InputError(Place{"port", 0, 0}, fmt::format("'{}' is a terminal that is in use", name),
                         "choose another name, or remove it if no bench is running there");
    std::filesystem::remove(name, error);
}

[[noreturn]] void refuse(const std::string& name) {
    throw InputError(Place{"port", 0, 0},
                     fmt::format("no serial line can be made as '{}' ({})", name, std::strerror(errno)),
                     "choose a name in a folder that you may write to");
}

} // namespace

Terminal::Terminal(std::string name) : name_(std::move(name)) {
    if (name_.empty())
        throw InputError(Place{"port", 0, 0}, "the name of the port is empty", "give one");
    clear_name(name_);
    std::array<char, 128> path{};
    master_.reset(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK));
    if (file() < 0 || grantpt(file()) != 0 || unlockpt(file()) != 0 || ptsname_r(file(), path.data(), path.size()) != 0)
        refuse(name_);
    target_ = path.data();
    // Kept open so that the line does not hang up when a client closes it.
    slave_.reset(open(target_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
    termios raw{};
    if (slave_.get() < 0 || tcgetattr(slave_.get(), &raw) != 0)
        refuse(name_);
    cfmakeraw(&raw);
    tcsetattr(slave_.get(), TCSANOW, &raw);
    if (symlink(target_.c_str(), name_.c_str()) != 0)
        refuse(name_);
}

Terminal::~Terminal() {
    std::error_code error;
    if (std::filesystem::read_symlink(name_, error).string() == target_) // only if it still leads to this terminal
        std::filesystem::remove(name_, error);
}

} // namespace graze
