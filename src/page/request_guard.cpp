#include "page/request_guard.hpp"

#include "graze/base/input_error.hpp"

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <sys/random.h>

#include <array>
#include <utility>

#include <fmt/format.h>

namespace graze {

std::string random_token() {
    std::array<std::uint8_t, 16> bytes{};
    // The system never gives fewer than 256 bytes in part, once it has gathered enough.
    if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
        throw InputError(fmt::format("the system gives no random numbers: {}", std::strerror(errno)), "");
    }
    std::string token;
    for (const std::uint8_t byte : bytes) {
        token += fmt::format("{:02x}", byte);
    }
    return token;
}

bool equal_in_constant_time(std::string_view one, std::string_view other) {
    if (one.size() != other.size()) {
        return false;
    }
    unsigned differences = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        differences |= static_cast<unsigned char>(one[i]) ^ static_cast<unsigned char>(other[i]);
    }
    return differences == 0;
}

RequestGuard::RequestGuard(std::string token, int port) : token_(std::move(token)), port_(std::to_string(port)) {}

RequestVerdict RequestGuard::examine_place(const RequestOrigin& request) const {
    const std::array<std::string, 2> hosts{"127.0.0.1:" + port_, "localhost:" + port_};
    if (!request.host || (*request.host != hosts[0] && *request.host != hosts[1])) {
        return RequestVerdict::wrong_host;
    }
    // The page was loaded from the same host, by the same name.
    if (request.origin && *request.origin != "http://" + *request.host) {
        return RequestVerdict::wrong_origin;
    }
    return RequestVerdict::accepted;
}

RequestVerdict RequestGuard::examine_page(const RequestOrigin& request) const {
    const RequestVerdict place = examine_place(request);
    if (place != RequestVerdict::accepted) {
        return place;
    }
    if (request.authorization) // who gives one has to give the right one
        return examine_data(request);
    return !request.token || equal_in_constant_time(*request.token, token_) ? RequestVerdict::accepted
                                                                            : RequestVerdict::wrong_token;
}

RequestVerdict RequestGuard::examine_data(const RequestOrigin& request) const {
    const RequestVerdict place = examine_place(request);
    if (place != RequestVerdict::accepted) {
        return place;
    }
    return request.authorization && equal_in_constant_time(*request.authorization, "Bearer " + token_)
               ? RequestVerdict::accepted
               : RequestVerdict::wrong_token;
}

} // namespace graze
