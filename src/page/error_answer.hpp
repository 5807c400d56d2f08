#pragma once

#include "graze/base/input_error.hpp"
#include "page/http_message.hpp"

#include <nlohmann/json_fwd.hpp>

#include <exception>
#include <string>

namespace graze {

/// An answer in JSON. Texts that are not UTF-8 are shown with replacement characters.
HttpAnswer json_answer(const nlohmann::json& value, int status = 200);

/// {problem, remedy, place: {file, line, column}}
nlohmann::json error_json(const InputError& error);

/// An answer that refuses a request. @param status of HTTP
HttpAnswer error_answer(int status, const std::string& problem, const std::string& remedy);

/// The answer to a request that has failed with an exception: InputErrors with all their places (400), Conflict (409),
/// and others (500), of which only a mistake in graze is a cause.
HttpAnswer error_answer(const std::exception_ptr& failure);

/// What is asked for contradicts what somebody else has done, or cannot be done now.
class RefusedRequest : public InputError {
public:
    /// @param status of HTTP, as 409
    RefusedRequest(int status, const std::string& problem, const std::string& remedy)
        : InputError(problem, remedy), status_(status) {}
    int status() const { return status_; }

private:
    int status_;
};

} // namespace graze
