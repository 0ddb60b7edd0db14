// Numbers: one, several, whole ones, each held to its range.
#include "api/read/read_fields.h"
#include "api/words/limit_words.h"

#include <algorithm>
#include <cmath>

namespace api {

namespace {

std::string words_of(const Range& range)
{
    std::string words = range.without_min ? "(" : "[";
    words += text_of(range.min) + ", " + text_of(range.max);
    words += range.without_max ? ')' : ']';
    return words;
}

} // namespace

bool ReadFields::number(const char* name, double& value, const Range& range, const char*)
{
    const Json* node = find(name);
    if (!node) return false;
    const std::optional<double> read = one_number(*node, at(name), range);
    if (read) value = *read;
    return read.has_value();
}

bool ReadFields::number(const char* name, std::optional<double>& value, const Range& range, const char* doc)
{
    double read = 0;
    if (!number(name, read, range, doc)) return false;
    value = read;
    return true;
}

bool ReadFields::point(const char* name, renderer::Vec3d& value, const char*)
{
    const auto read = numbers<3>(name, kCoordinate);
    if (read) value = {(*read)[0], (*read)[1], (*read)[2]};
    return read.has_value();
}

bool ReadFields::direction(const char* name, renderer::Vec3d& value, const char*)
{
    const auto read = numbers<3>(name, kCoordinate);
    if (!read) return false;
    const renderer::Vec3d vector{(*read)[0], (*read)[1], (*read)[2]};
    if (vector == renderer::Vec3d{}) {
        fault(at(name), "zero_length", "[0, 0, 0] points nowhere: any other length will do");
        return false;
    }
    value = vector;
    return true;
}

void ReadFields::color(const char* name, renderer::Rgb& value, const Range& range, const char*)
{
    if (const auto read = numbers<3>(name, range))
        value = {
            static_cast<float>((*read)[0]), static_cast<float>((*read)[1]), static_cast<float>((*read)[2])};
}

void ReadFields::color(const char* name,
                       std::optional<renderer::Rgb>& value,
                       const Range& range,
                       const char* doc)
{
    renderer::Rgb read{-1, -1, -1}; // no colour that a range of ours holds
    color(name, read, range, doc);
    if (read.r >= 0) value = read;
}

void ReadFields::coefficients(const char* name, std::vector<double>& values, const Range& range, const char*)
{
    const Json* node = find(name);
    if (!node) return;
    if (!node->is_array()) {
        if (const std::optional<double> read = one_number(*node, at(name), range)) values = {*read};
        return;
    }
    if (node->empty() || node->size() > renderer::kMostWavelengths)
        return fault(at(name),
                     "wrong_length",
                     "expected a number or 1 to " + std::to_string(renderer::kMostWavelengths) +
                         " of them, got " + std::to_string(node->size()));
    std::vector<double> read;
    for (std::size_t i = 0; i < node->size(); ++i)
        if (const std::optional<double> value = one_number((*node)[i], at(name, i), range))
            read.push_back(*value);
    if (read.size() == node->size()) values = std::move(read);
}

std::optional<std::uint64_t> ReadFields::whole(const char* name, const WholeRange& range)
{
    const Json* node = find(name);
    if (!node) return std::nullopt;
    if (!node->is_number()) {
        wrong_type(at(name), "a whole number", *node);
        return std::nullopt;
    }
    const renderer::Limits& limits = state_.context.limits;
    const std::uint64_t limit = range.limit ? value_of(range.limit, limits) : range.max;
    const std::uint64_t max = std::min(range.max, limit);
    const double as_double = node->get<double>();
    if (!node->is_number_integer() && as_double != std::trunc(as_double)) {
        fault(at(name), "not_integer", text_of(as_double) + " is not a whole number");
        return std::nullopt;
    }
    constexpr double beyond = 18446744073709551616.0; // 2^64: floats below convert
    const bool too_small = as_double < 0;
    const bool too_large = !node->is_number_integer() && as_double >= beyond;
    const std::uint64_t value = too_small || too_large       ? 0
                                : node->is_number_unsigned() ? node->get<std::uint64_t>()
                                                             : static_cast<std::uint64_t>(as_double);
    if (!too_small && !too_large && value >= range.min && value <= max) return value;
    if (range.limit && !too_small && !too_large && value > limit && max == limit)
        state_.faults.add(over_limit(at(name), range.limit, value, limits));
    else
        fault(at(name),
              "out_of_range",
              text_of(*node) + " is not in [" + std::to_string(range.min) + ", " + std::to_string(max) + "]");
    return std::nullopt;
}

std::optional<double> ReadFields::one_number(const Json& node, const std::string& pointer, const Range& range)
{
    if (node.is_object() && node.contains("image")) {
        fault(pointer, "unsupported", "no texture can stand here; available: a number");
        return std::nullopt;
    }
    if (!node.is_number()) {
        wrong_type(pointer, "a number", node);
        return std::nullopt;
    }
    const double value = node.get<double>();
    if (range.contains(value)) return value;
    fault(pointer, "out_of_range", text_of(value) + " is not in " + words_of(range));
    return std::nullopt;
}

bool ReadFields::read_numbers(const char* name, const Range& range, double* values, std::size_t count)
{
    const Json* node = find(name);
    if (!node) return false;
    const std::string expected = "an array of " + std::to_string(count) + " numbers";
    if (node->is_object() && node->contains("image")) {
        fault(at(name), "unsupported", "no texture can stand here; available: " + expected);
        return false;
    }
    if (!node->is_array()) {
        wrong_type(at(name), expected.c_str(), *node);
        return false;
    }
    if (node->size() != count) {
        fault(at(name), "wrong_length", "expected " + expected + ", got " + std::to_string(node->size()));
        return false;
    }
    bool good = true;
    for (std::size_t i = 0; i < count; ++i) {
        const std::optional<double> value = one_number((*node)[i], at(name, i), range);
        values[i] = value.value_or(0);
        good = good && value.has_value();
    }
    return good;
}

} // namespace api
