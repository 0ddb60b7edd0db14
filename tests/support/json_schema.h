// JsonSchemas: holds a JSON value against JSON Schema (2020-12), the subset that our own documents use.
//
// Errors   a keyword it does not know, or a $ref to nowhere, is a fault like any other: nothing passes
// unread.
#pragma once

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <vector>

namespace test_support {

class JsonSchemas {
public:
    // `uri` is what a $ref writes before its "#".
    void add(const std::string& uri, nlohmann::json document);

    // Every fault of `value` against the schema that `reference` names
    // ("openapi.json#/components/schemas/Job"), each as "/pointer: what". Empty: it conforms.
    std::vector<std::string> check(const nlohmann::json& value, const std::string& reference) const;
    // The same against a schema at hand, whose local $refs ("#/...") are looked up in the document `uri`.
    std::vector<std::string>
    check(const nlohmann::json& value, const nlohmann::json& schema, const std::string& uri) const;

private:
    std::map<std::string, nlohmann::json> documents_;
};

} // namespace test_support
