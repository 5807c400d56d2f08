#include "page/request_guard.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

RequestOrigin proper_origin() {
    RequestOrigin request;
    request.host = "127.0.0.1:4000";
    request.authorization = "Bearer 00ff";
    request.token = "00ff";
    return request;
}

TEST(RequestGuard, AcceptsItsOwnPageByEitherName) {
    const RequestGuard guard("00ff", 4000);
    RequestOrigin request = proper_origin();
    EXPECT_EQ(guard.examine_data(request), RequestVerdict::accepted);
    EXPECT_EQ(guard.examine_page(request), RequestVerdict::accepted);
    request.host = "localhost:4000";
    request.origin = "http://localhost:4000";
    EXPECT_EQ(guard.examine_data(request), RequestVerdict::accepted);
}

TEST(RequestGuard, RefusesOtherHosts) {
    const RequestGuard guard("00ff", 4000);
    RequestOrigin request = proper_origin();
    for (const char* host :
         {"127.0.0.1", "127.0.0.1:4001", "localhost:80", "evil.example:4000", "127.0.0.1:4000.evil.example", ""}) {
        request.host = host;
        EXPECT_EQ(guard.examine_data(request), RequestVerdict::wrong_host) << host;
        EXPECT_EQ(guard.examine_page(request), RequestVerdict::wrong_host) << host;
    }
    request.host.reset();
    EXPECT_EQ(guard.examine_data(request), RequestVerdict::wrong_host);
}

TEST(RequestGuard, RefusesOtherOrigins) {
    const RequestGuard guard("00ff", 4000);
    RequestOrigin request = proper_origin();
    for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:4000", "http://127.0.0.1:4001",
                               "http://127.0.0.1:4000/", ""}) {
        request.origin = origin;
        EXPECT_EQ(guard.examine_data(request), RequestVerdict::wrong_origin) << origin;
        EXPECT_EQ(guard.examine_page(request), RequestVerdict::wrong_origin) << origin;
    }
}

TEST(RequestGuard, RefusesOtherTokens) {
    const RequestGuard guard("00ff", 4000);
    RequestOrigin request = proper_origin();
    for (const char* token : {"00fe", "00f", "00ff0", "", "00FF"}) {
        request.token = token;
        request.authorization = std::string("Bearer ") + token;
        EXPECT_EQ(guard.examine_data(request), RequestVerdict::wrong_token) << token;
        EXPECT_EQ(guard.examine_page(request), RequestVerdict::wrong_token) << token;
    }
    // The token of the address serves for the page only, that of the header for data only.
    request = proper_origin();
    request.authorization.reset();
    EXPECT_EQ(guard.examine_data(request), RequestVerdict::wrong_token);
    request = proper_origin();
    request.token.reset();
    EXPECT_EQ(guard.examine_page(request), RequestVerdict::accepted);
    request.authorization = "Bearer 00fe";
    EXPECT_EQ(guard.examine_page(request), RequestVerdict::wrong_token);
}

TEST(RandomToken, Has128BitsThatDiffer) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32U);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_NE(token, random_token());
}

TEST(EqualInConstantTime, ComparesTexts) {
    EXPECT_TRUE(equal_in_constant_time("", ""));
    EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
    EXPECT_FALSE(equal_in_constant_time("abc", "abd"));
    EXPECT_FALSE(equal_in_constant_time("abc", "ab"));
}

} // namespace
} // namespace graze
