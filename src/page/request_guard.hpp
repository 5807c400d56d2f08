#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace graze {

/// 128 random bits of the operating system as hexadecimal digits. Throws InputError if it gives none.
std::string random_token();

/// The time that this takes does not depend on where two texts differ, so that a token cannot be guessed digit by
/// digit.
bool equal_in_constant_time(std::string_view one, std::string_view other);

/// What a request says of itself; what it does not say is absent.
struct RequestOrigin {
    std::optional<std::string> host;          ///< the header Host
    std::optional<std::string> origin;        ///< the header Origin, which browsers send
    std::optional<std::string> authorization; ///< the header Authorization
    std::optional<std::string> token;         ///< in the address, which only the page itself may have
};

enum class RequestVerdict { accepted, wrong_host, wrong_origin, wrong_token };

/// Decides which requests a server on the loopback interface answers. A page of another origin can send requests to it
/// from the user's browser, and by a name that resolves to this machine it can even read what they give: hence the
/// checks of Host and Origin. Other users of the machine can connect too: hence the token.
class RequestGuard {
public:
    RequestGuard(std::string token, int port);

    const std::string& token() const { return token_; }

    /// Whether a request for the page itself is answered. It has no data, and the browser loads it again from an
    /// address from which the page has removed the token: only a wrong token is refused here.
    RequestVerdict examine_page(const RequestOrigin& request) const;

    /// Whether a request for data is answered, which says `Authorization: Bearer TOKEN`.
    RequestVerdict examine_data(const RequestOrigin& request) const;

private:
    RequestVerdict examine_place(const RequestOrigin& request) const;

    std::string token_;
    std::string port_;
};

} // namespace graze
