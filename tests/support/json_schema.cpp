#include "tests/support/json_schema.h"

#include <algorithm>
#include <regex>
#include <set>

namespace test_support {

namespace {

using nlohmann::json;
using Faults = std::vector<std::string>;
using Documents = std::map<std::string, json>;

// Says nothing about what is valid.
bool is_annotation(const std::string& keyword)
{
    static const std::set<std::string> names{"title",
                                             "description",
                                             "default",
                                             "examples",
                                             "example",
                                             "format",
                                             "deprecated",
                                             "readOnly",
                                             "writeOnly",
                                             "$schema",
                                             "$id",
                                             "$defs",
                                             "$comment",
                                             "contentEncoding",
                                             "$anchor",
                                             "contentMediaType"};
    return names.contains(keyword) || keyword.rfind("x-", 0) == 0;
}

bool is_type(const json& value, const std::string& type)
{
    if (type == "null") return value.is_null();
    if (type == "boolean") return value.is_boolean();
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "number") return value.is_number();
    if (type == "integer")
        return value.is_number_integer() ||
               (value.is_number_float() &&
                value.get<double>() == static_cast<double>(value.get<std::int64_t>()));
    return false;
}

std::size_t code_points(const std::string& text)
{
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

class Checker {
public:
    Checker(const Documents& documents, Faults& faults) : documents_(documents), faults_(faults) {}

    void
    follow(const json& value, const std::string& reference, const std::string& uri, const std::string& at)
    {
        const std::size_t hash = reference.find('#');
        const std::string name = hash == 0 ? uri : reference.substr(0, hash);
        const auto document = documents_.find(name);
        if (document == documents_.end()) return fault(at, "$ref to an unknown document: " + reference);
        const json::json_pointer pointer(hash == std::string::npos ? "" : reference.substr(hash + 1));
        if (!document->second.contains(pointer)) return fault(at, "$ref to nowhere: " + reference);
        check(value, document->second.at(pointer), name, at);
    }

    void check(const json& value, const json& schema, const std::string& uri, const std::string& at)
    {
        if (schema.is_boolean()) {
            if (!schema.get<bool>()) fault(at, "nothing is allowed here");
            return;
        }
        for (const auto& [keyword, rule] : schema.items())
            if (!is_annotation(keyword) && !any(value, keyword, rule, uri, at) &&
                !numbers(value, keyword, rule, at) && !strings(value, keyword, rule, at) &&
                !arrays(value, keyword, rule, schema, uri, at) &&
                !objects(value, keyword, rule, schema, uri, at))
                fault(at, "the schema uses \"" + keyword + "\", which this checker does not know");
    }

private:
    void fault(const std::string& at, const std::string& what)
    {
        faults_.push_back((at.empty() ? "/" : at) + ": " + what);
    }

    std::size_t matches(const json& value,
                        const json& schemas,
                        const std::string& uri,
                        const std::string& at,
                        Faults& why) const
    {
        std::size_t count = 0;
        for (const json& schema : schemas) {
            Faults faults;
            Checker(documents_, faults).check(value, schema, uri, at);
            if (faults.empty()) ++count;
            why.insert(why.end(), faults.begin(), faults.end());
        }
        return count;
    }

    bool any(const json& value,
             const std::string& keyword,
             const json& rule,
             const std::string& uri,
             const std::string& at)
    {
        if (keyword == "$ref") {
            follow(value, rule.get<std::string>(), uri, at);
        } else if (keyword == "type") {
            const json types = rule.is_array() ? rule : json::array({rule});
            if (std::none_of(types.begin(), types.end(), [&](const json& t) {
                    return is_type(value, t.get<std::string>());
                }))
                fault(at, "is " + std::string(value.type_name()) + ", not " + rule.dump());
        } else if (keyword == "enum") {
            if (std::find(rule.begin(), rule.end(), value) == rule.end())
                fault(at, value.dump() + " is not of " + rule.dump());
        } else if (keyword == "const") {
            if (value != rule) fault(at, value.dump() + " is not " + rule.dump());
        } else if (keyword == "allOf") {
            for (const json& schema : rule)
                check(value, schema, uri, at);
        } else if (keyword == "anyOf" || keyword == "oneOf") {
            Faults why;
            const std::size_t count = matches(value, rule, uri, at, why);
            if (count == 0) {
                fault(at, "fits none of " + keyword + ":");
                for (const std::string& line : why)
                    faults_.push_back("  " + line);
            } else if (count > 1 && keyword == "oneOf") {
                fault(at, "fits " + std::to_string(count) + " of oneOf");
            }
        } else if (keyword == "not") {
            Faults why;
            if (matches(value, json::array({rule}), uri, at, why) == 1)
                fault(at, "fits what it must not: " + rule.dump());
        } else {
            return false;
        }
        return true;
    }

    bool numbers(const json& value, const std::string& keyword, const json& rule, const std::string& at)
    {
        static const std::set<std::string> names{
            "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum", "multipleOf"};
        if (!names.contains(keyword)) return false;
        if (!value.is_number()) return true;
        const double v = value.get<double>(), bound = rule.get<double>();
        const bool good = keyword == "minimum"            ? v >= bound
                          : keyword == "maximum"          ? v <= bound
                          : keyword == "exclusiveMinimum" ? v > bound
                          : keyword == "exclusiveMaximum"
                              ? v < bound
                              : v / bound == static_cast<double>(static_cast<std::int64_t>(v / bound));
        if (!good) fault(at, value.dump() + " against " + keyword + " " + rule.dump());
        return true;
    }

    bool strings(const json& value, const std::string& keyword, const json& rule, const std::string& at)
    {
        if (keyword != "pattern" && keyword != "minLength" && keyword != "maxLength") return false;
        if (!value.is_string()) return true;
        const std::string text = value.get<std::string>();
        const bool good =
            keyword == "pattern"
                ? std::regex_search(text, std::regex(rule.get<std::string>(), std::regex::ECMAScript))
            : keyword == "minLength" ? code_points(text) >= rule.get<std::size_t>()
                                     : code_points(text) <= rule.get<std::size_t>();
        if (!good) fault(at, value.dump() + " against " + keyword + " " + rule.dump());
        return true;
    }

    bool arrays(const json& value,
                const std::string& keyword,
                const json& rule,
                const json& schema,
                const std::string& uri,
                const std::string& at)
    {
        static const std::set<std::string> names{
            "items", "prefixItems", "minItems", "maxItems", "uniqueItems"};
        if (!names.contains(keyword)) return false;
        if (!value.is_array()) return true;
        if (keyword == "items") {
            for (std::size_t i = schema.contains("prefixItems") ? schema["prefixItems"].size() : 0;
                 i < value.size();
                 ++i)
                check(value[i], rule, uri, at + "/" + std::to_string(i));
        } else if (keyword == "prefixItems") {
            for (std::size_t i = 0; i < std::min(rule.size(), value.size()); ++i)
                check(value[i], rule[i], uri, at + "/" + std::to_string(i));
        } else if (keyword == "uniqueItems") {
            if (rule.get<bool>() && std::set<json>(value.begin(), value.end()).size() != value.size())
                fault(at, "has an item twice");
        } else if (keyword == "minItems" ? value.size() < rule.get<std::size_t>()
                                         : value.size() > rule.get<std::size_t>()) {
            fault(at, std::to_string(value.size()) + " items against " + keyword + " " + rule.dump());
        }
        return true;
    }

    bool objects(const json& value,
                 const std::string& keyword,
                 const json& rule,
                 const json& schema,
                 const std::string& uri,
                 const std::string& at)
    {
        static const std::set<std::string> names{"properties",
                                                 "required",
                                                 "additionalProperties",
                                                 "patternProperties",
                                                 "propertyNames",
                                                 "minProperties",
                                                 "maxProperties",
                                                 "dependentRequired",
                                                 "unevaluatedProperties"};
        if (!names.contains(keyword) || keyword == "unevaluatedProperties") return false;
        if (!value.is_object()) return true;
        if (keyword == "required") {
            for (const json& name : rule)
                if (!value.contains(name.get<std::string>())) fault(at, "lacks " + name.dump());
        } else if (keyword == "minProperties" || keyword == "maxProperties") {
            const bool good = keyword == "minProperties" ? value.size() >= rule.get<std::size_t>()
                                                         : value.size() <= rule.get<std::size_t>();
            if (!good)
                fault(at, std::to_string(value.size()) + " members against " + keyword + " " + rule.dump());
        } else if (keyword == "dependentRequired") {
            for (const auto& [name, others] : rule.items())
                for (const json& other : others)
                    if (value.contains(name) && !value.contains(other.get<std::string>()))
                        fault(at, "has " + name + " without " + other.dump());
        } else {
            for (const auto& [name, member] : value.items())
                one_member(name, member, keyword, rule, schema, uri, at);
        }
        return true;
    }

    void one_member(const std::string& name,
                    const json& member,
                    const std::string& keyword,
                    const json& rule,
                    const json& schema,
                    const std::string& uri,
                    const std::string& at)
    {
        const std::string where = at + "/" + name;
        if (keyword == "properties") {
            if (rule.contains(name)) check(member, rule[name], uri, where);
        } else if (keyword == "propertyNames") {
            check(json(name), rule, uri, where);
        } else if (keyword == "patternProperties") {
            for (const auto& [pattern, inner] : rule.items())
                if (std::regex_search(name, std::regex(pattern))) check(member, inner, uri, where);
        } else if (!named(name, schema)) { // additionalProperties
            if (rule.is_boolean() && !rule.get<bool>())
                fault(where, "is a member that the schema does not name");
            else
                check(member, rule, uri, where);
        }
    }

    static bool named(const std::string& name, const json& schema)
    {
        if (schema.contains("properties") && schema["properties"].contains(name)) return true;
        if (schema.contains("patternProperties"))
            for (const auto& entry : schema["patternProperties"].items())
                if (std::regex_search(name, std::regex(entry.key()))) return true;
        return false;
    }

    const Documents& documents_;
    Faults& faults_;
};

} // namespace

void JsonSchemas::add(const std::string& uri, json document)
{
    documents_[uri] = std::move(document);
}

std::vector<std::string> JsonSchemas::check(const json& value, const std::string& reference) const
{
    Faults faults;
    Checker(documents_, faults).follow(value, reference, "", "");
    return faults;
}

std::vector<std::string>
JsonSchemas::check(const json& value, const json& schema, const std::string& uri) const
{
    Faults faults;
    Checker(documents_, faults).check(value, schema, uri, "");
    return faults;
}

} // namespace test_support
