// Json: a JSON value as this room holds it.
//
// Trap  copying, comparing and dumping recurse: a value from outside is only held after parse_json has
// bounded its depth.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace api {

using Json = nlohmann::json;

// JSON text; bytes that are not UTF-8 are replaced, never thrown about.
std::string text_of(const Json& json, bool pretty = false);

// "a string", "an object", "null": for sentences.
const char* type_words(const Json& json);

// The shortest decimal that reads back to the same number.
std::string text_of(double number);

// The double that is written shortest among those that read back to the float `value`: 0.6f gives 0.6.
double shortest_double(float value);

} // namespace api
