#include "tests/support/reference_table.h"

#include "tests/support/places.h"

#include <fstream>
#include <sstream>

namespace tests {

namespace {

std::vector<std::string> cells_of(const std::string& line)
{
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');)
        cells.push_back(cell);
    return cells;
}

} // namespace

std::vector<TableRow> reference_table(const std::string& name)
{
    std::ifstream file(source_dir() + "/../shared/reference/" + name);
    std::vector<std::string> head;
    std::vector<TableRow> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        const std::vector<std::string> cells = cells_of(line);
        if (head.empty()) {
            head = cells;
            continue;
        }
        std::map<std::string, std::string> row;
        for (std::size_t i = 0; i < head.size(); ++i)
            row[head[i]] = i < cells.size() ? cells[i] : "";
        rows.emplace_back(std::move(row));
    }
    return rows;
}

} // namespace tests
