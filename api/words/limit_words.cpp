#include "api/words/limit_words.h"

#include <algorithm>
#include <cassert>

namespace api {

namespace {

const renderer::LimitEntry* find_limit(std::string_view name)
{
    for (const renderer::LimitEntry& entry : renderer::limit_table())
        if (entry.name == name) return &entry;
    return nullptr;
}

} // namespace

std::string flag_of(std::string_view limit)
{
    std::string flag = "--limit-" + std::string(limit);
    std::replace(flag.begin(), flag.end(), '_', '-');
    return flag;
}

std::string environment_of(std::string_view limit)
{
    std::string name = "HELIOGRAPH_LIMIT_" + std::string(limit);
    std::transform(name.begin(), name.end(), name.begin(), [](char c) {
        return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    });
    return name;
}

std::string raise_words(std::string_view limit)
{
    return "the service raises it with " + flag_of(limit);
}

std::uint64_t value_of(std::string_view limit, const renderer::Limits& limits)
{
    const renderer::LimitEntry* entry = find_limit(limit);
    assert(entry);
    return entry ? limits.*entry->value : 0;
}

namespace {

std::string with_unit(std::uint64_t value, std::string_view limit)
{
    const renderer::LimitEntry* entry = find_limit(limit);
    return std::to_string(value) + (entry && *entry->unit ? std::string(" ") + entry->unit : std::string());
}

} // namespace

std::string over_limit_words(std::string_view what, std::string_view limit, const renderer::Limits& limits)
{
    return std::string(what) + " is over the limit " + std::string(limit) + ", " +
           with_unit(value_of(limit, limits), limit) + "; " + raise_words(limit);
}

Problem
over_limit(std::string pointer, std::string_view limit, std::uint64_t asked, const renderer::Limits& limits)
{
    return {std::move(pointer), "over_limit", over_limit_words(with_unit(asked, limit), limit, limits)};
}

} // namespace api
