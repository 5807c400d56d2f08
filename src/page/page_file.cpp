#include "graze/page/page_file.hpp"

#include "graze/base/input_error.hpp"
#include "page/page_html.hpp"
#include "page/stored_page.hpp"

namespace graze {

std::string page_with(std::string_view html, const std::string& data) {
    constexpr std::string_view begin = "<script type=\"application/json\" id=\"stored\">", end = "</script>";
    constexpr std::string_view once = " nonce=\"@nonce@\""; // which a server would replace
    std::string page(html);
    if (const std::size_t place = page.find(once); place != std::string::npos)
        page.erase(place, once.size());
    if (const std::size_t place = page.find(begin); place != std::string::npos) {
        const std::size_t from = place + begin.size();
        page.replace(from, page.find(end, from) - from, data);
        return page;
    }
    const std::size_t first = page.find("<script"); // which reads the data when it runs
    page.insert(first == std::string::npos ? page.size() : first, std::string(begin) + data + std::string(end) + "\n");
    return page;
}

std::string page_file(const ResultFile& file, const PageFileOptions& options) {
    if (page_html().empty())
        throw InputError("this graze was built without its page", "build it where esbuild is installed");
    return page_with(page_html(), stored_page(file, options));
}

} // namespace graze
