#include "page/error_answer.hpp"

#include "graze/base/input_errors.hpp"
#include "graze/base/printable.hpp"
#include "page/json_text.hpp"

#include <nlohmann/json.hpp>

#include <new>

namespace graze {

HttpAnswer json_answer(const nlohmann::json& value, int status) {
    HttpAnswer answer;
    answer.status = status;
    answer.body = json_text(value);
    return answer;
}

nlohmann::json error_json(const InputError& error) {
    return {{"problem", error.problem()},
            {"remedy", error.remedy()},
            {"place", {{"file", error.place().file}, {"line", error.place().line}, {"column", error.place().column}}}};
}

HttpAnswer error_answer(int status, const std::string& problem, const std::string& remedy) {
    return json_answer({{"error", error_json(InputError(problem, remedy))}}, status);
}

HttpAnswer error_answer(const std::exception_ptr& failure) {
    try {
        std::rethrow_exception(failure);
    } catch (const RefusedRequest& refused) {
        return error_answer(refused.status(), refused.problem(), refused.remedy());
    } catch (const InputErrors& errors) {
        nlohmann::json list = nlohmann::json::array();
        for (const InputError& error : errors.all())
            list.push_back(error_json(error));
        return json_answer({{"errors", std::move(list)}}, 400);
    } catch (const InputError& error) {
        return json_answer({{"error", error_json(error)}}, 400);
    } catch (const Error& error) {
        return error_answer(500, error.problem(), error.remedy());
    } catch (const std::bad_alloc&) {
        return error_answer(500, "there is not enough memory", "ask for less");
    } catch (const std::exception& error) {
        return error_answer(500, printable_line(error.what()), "please report this, with what led to it");
    }
}

} // namespace graze
