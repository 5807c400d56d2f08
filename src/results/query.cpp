#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/require.hpp"
#include "results/result_file_state.hpp"

#include <fmt/format.h>

namespace graze {

namespace {

constexpr std::size_t longest_shown = 80; ///< characters of a text in a message

} // namespace

struct ResultFile::Rows::State {
    Statement statement;
    bool on_row = false;
    /// Checks a column of the current row, and returns its index.
    int at(std::size_t column) const {
        if (!on_row)
            throw OrderError("there is no row to be read: call next, and read only while it returns true");
        require_index(column, static_cast<std::size_t>(statement.columns()), "column");
        return static_cast<int>(column);
    }
};
ResultFile::Rows::Rows(std::unique_ptr<State> state) : state_(std::move(state)) {}
ResultFile::Rows::~Rows() = default;
ResultFile::Rows::Rows(Rows&&) noexcept = default;
bool ResultFile::Rows::next() {
    return state_->on_row = state_->statement.step();
}
std::size_t ResultFile::Rows::columns() const {
    return static_cast<std::size_t>(state_->statement.columns());
}
std::string ResultFile::Rows::column_name(std::size_t column) const {
    require_index(column, columns(), "column");
    return state_->statement.name(static_cast<int>(column));
}
bool ResultFile::Rows::is_null(std::size_t column) const {
    return state_->statement.is_null(state_->at(column));
}
bool ResultFile::Rows::is_text(std::size_t column) const {
    return state_->statement.type(state_->at(column)) == SQLITE_TEXT;
}
bool ResultFile::Rows::is_integer(std::size_t column) const {
    return state_->statement.type(state_->at(column)) == SQLITE_INTEGER;
}
double ResultFile::Rows::number(std::size_t column) const {
    const int type = state_->statement.type(state_->at(column));
    if (type == SQLITE_TEXT || type == SQLITE_BLOB) // SQLite would take the digits at its beginning, or 0
        throw InputError(fmt::format("'{}' is no number", printable_line(shortened(text(column), longest_shown))),
                         "name a quantity that is one");
    return state_->statement.number(state_->at(column));
}
std::int64_t ResultFile::Rows::integer(std::size_t column) const {
    return state_->statement.integer(state_->at(column));
}
std::string ResultFile::Rows::text(std::size_t column) const {
    return state_->statement.text(state_->at(column));
}

ResultFile::Rows ResultFile::query(const std::string& sql, const std::vector<double>& values) const {
    auto state = std::make_unique<Rows::State>(Rows::State{state_->database.prepare_query(sql), false});
    for (std::size_t i = 0; i < values.size(); ++i)
        state->statement.bind(static_cast<int>(i) + 1, values[i]);
    return Rows(std::move(state));
}

} // namespace graze
