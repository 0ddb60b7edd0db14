// CsvTable: comma-separated rows under a head, as spreadsheets write them.
//
// Lines that begin with # and empty lines are left out. Cells are trimmed; there are no quotes.
// Errors  UserError(usage) with file and line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clients {

class CsvTable {
public:
    CsvTable(std::string name, std::string_view text); // `name`: of the file, for errors

    [[nodiscard]] std::size_t rows() const { return rows_.size(); }
    [[nodiscard]] bool has(std::string_view column) const { return find(column).has_value(); }
    [[nodiscard]] std::size_t column(std::string_view name) const; // an error if it is not there

    // "" where the row has no such cell.
    [[nodiscard]] const std::string& text(std::size_t row, std::string_view column) const;
    // Finite; an error where it is no number.
    [[nodiscard]] double number(std::size_t row, std::string_view column) const;

    // Written into the column of that name, which is added after the others where there is none.
    void set(std::size_t row, std::string_view column, double value);

    [[nodiscard]] std::string write() const;
    [[noreturn]] void fail(std::size_t row, const std::string& message) const;

private:
    struct Row {
        std::size_t line = 0;
        std::vector<std::string> cells;
    };
    [[nodiscard]] std::optional<std::size_t> find(std::string_view column) const;

    std::string name_;
    std::vector<std::string> head_;
    std::vector<Row> rows_;
};

} // namespace clients
