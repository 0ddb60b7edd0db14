#include "api/json/json.h"

#include <array>
#include <charconv>

namespace api {

std::string text_of(const Json& json, bool pretty)
{
    return json.dump(pretty ? 2 : -1, ' ', false, Json::error_handler_t::replace);
}

const char* type_words(const Json& json)
{
    switch (json.type()) {
    case Json::value_t::null:
        return "null";
    case Json::value_t::object:
        return "an object";
    case Json::value_t::array:
        return "an array";
    case Json::value_t::string:
        return "a string";
    case Json::value_t::boolean:
        return "a boolean";
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float:
        return "a number";
    case Json::value_t::binary:
    case Json::value_t::discarded:
        break;
    }
    return "something that is not JSON";
}

std::string text_of(double number)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

double shortest_double(float value)
{
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    double shortest = 0;
    std::from_chars(text.data(), end, shortest);
    // Rounding twice, decimal to double to float, could in principle land beside.
    return static_cast<float>(shortest) == value ? shortest : static_cast<double>(value);
}

} // namespace api
