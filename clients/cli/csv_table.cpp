#include "clients/cli/csv_table.h"

#include "clients/cli/user_error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace clients {

namespace {

std::string trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> cells_of(std::string_view line)
{
    std::vector<std::string> cells;
    for (;;) {
        const auto comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

} // namespace

CsvTable::CsvTable(std::string name, std::string_view text) : name_(std::move(name))
{
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    for (std::size_t line = 1; !text.empty(); ++line) {
        const auto end = std::min(text.find('\n'), text.size());
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (trimmed(content).empty() || content.starts_with('#')) continue;
        std::vector<std::string> cells = cells_of(content);
        if (head_.empty()) {
            head_ = std::move(cells);
            for (std::size_t i = 0; i < head_.size(); ++i)
                if (std::find(head_.begin(), head_.begin() + static_cast<std::ptrdiff_t>(i), head_[i]) !=
                    head_.begin() + static_cast<std::ptrdiff_t>(i))
                    throw UserError(ExitCode::usage,
                                    name_ + ':' + std::to_string(line) + ": column " + head_[i] +
                                        " stands twice");
            continue;
        }
        if (cells.size() > head_.size())
            throw UserError(ExitCode::usage,
                            name_ + ':' + std::to_string(line) + ": " + std::to_string(cells.size()) +
                                " cells under " + std::to_string(head_.size()) + " columns");
        cells.resize(head_.size());
        rows_.push_back({line, std::move(cells)});
    }
    if (head_.empty()) throw UserError(ExitCode::usage, name_ + ": there is no line that names the columns");
}

std::optional<std::size_t> CsvTable::find(std::string_view column) const
{
    const auto found = std::find(head_.begin(), head_.end(), column);
    if (found == head_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - head_.begin());
}

std::size_t CsvTable::column(std::string_view name) const
{
    if (const auto found = find(name)) return *found;
    std::string columns;
    for (const std::string& each : head_)
        (columns += columns.empty() ? "" : ", ") += each;
    throw UserError(ExitCode::usage,
                    name_ + ": there is no column " + std::string(name) + "; there are: " + columns);
}

const std::string& CsvTable::text(std::size_t row, std::string_view column) const
{
    static const std::string none;
    const auto found = find(column);
    return found ? rows_[row].cells[*found] : none;
}

double CsvTable::number(std::size_t row, std::string_view name) const
{
    const std::string& cell = rows_[row].cells[column(name)];
    double value = 0;
    const char* const end = cell.data() + cell.size();
    const char* const begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
    const auto read = std::from_chars(begin, end, value);
    if (read.ec != std::errc{} || read.ptr != end || !std::isfinite(value))
        fail(row, std::string(name) + ": \"" + cell + "\" is not a number");
    return value;
}

void CsvTable::set(std::size_t row, std::string_view column, double value)
{
    auto found = find(column);
    if (!found) {
        found = head_.size();
        head_.emplace_back(column);
        for (Row& each : rows_)
            each.cells.resize(head_.size());
    }
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.12g", value);
    rows_[row].cells[*found] = buffer;
}

std::string CsvTable::write() const
{
    std::string text;
    const auto line = [&](const std::vector<std::string>& cells) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            (text += i == 0 ? "" : ",") += cells[i];
        text += '\n';
    };
    line(head_);
    for (const Row& row : rows_)
        line(row.cells);
    return text;
}

void CsvTable::fail(std::size_t row, const std::string& message) const
{
    throw UserError(ExitCode::usage, name_ + ':' + std::to_string(rows_[row].line) + ": " + message);
}

} // namespace clients
