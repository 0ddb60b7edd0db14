#include "api/json/pointer.h"

#include <algorithm>

namespace api {

namespace {

// Takes the first step off `pointer`, with its slash.
std::string_view take_step(std::string_view& pointer)
{
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string_view step = pointer.substr(0, end);
    pointer.remove_prefix(end);
    return step;
}

bool is_index(std::string_view step)
{
    return step.size() > 1 &&
           std::all_of(step.begin() + 1, step.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

std::string pointer_to(std::string_view base, std::string_view member)
{
    std::string pointer(base);
    pointer += '/';
    for (const char c : member) {
        if (c == '~')
            pointer += "~0";
        else if (c == '/')
            pointer += "~1";
        else
            pointer += c;
    }
    return pointer;
}

std::string pointer_to(std::string_view base, std::size_t index)
{
    return std::string(base) + '/' + std::to_string(index);
}

bool comes_before(std::string_view a, std::string_view b)
{
    while (!a.empty() && !b.empty()) {
        const std::string_view x = take_step(a), y = take_step(b);
        if (x == y) continue;
        if (is_index(x) && is_index(y) && x.size() != y.size()) return x.size() < y.size();
        return x < y;
    }
    return a.empty() && !b.empty();
}

bool is_within(std::string_view pointer, std::string_view base)
{
    return pointer.starts_with(base) && (pointer.size() == base.size() || pointer[base.size()] == '/');
}

} // namespace api
