// Tables of ../shared/reference: comma-separated columns under a head, after lines that begin with #.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace tests {

class TableRow {
public:
    explicit TableRow(std::map<std::string, std::string> cells) : cells_(std::move(cells)) {}
    const std::string& text(const std::string& column) const { return cells_.at(column); }
    double number(const std::string& column) const { return std::stod(cells_.at(column)); }

private:
    std::map<std::string, std::string> cells_;
};

// Of the file ../shared/reference/`name`; empty where it is absent: then the test must skip.
std::vector<TableRow> reference_table(const std::string& name);

} // namespace tests
