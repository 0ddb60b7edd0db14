#include "api/schema/schema_fields.h"

#include "api/fields/job_fields.h"

namespace api {

namespace {

Json text_schema(std::size_t shortest, std::size_t longest)
{
    return {{"type", "string"}, {"minLength", shortest}, {"maxLength", longest}};
}

} // namespace

SchemaFields::SchemaFields()
    : schema_{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}}
{
}

Json SchemaFields::schema() &&
{
    return std::move(schema_);
}

void SchemaFields::number(const char* name, double value, const Range& range, const char* doc)
{
    Json member = told(within(range), doc);
    member["default"] = value;
    put(name, std::move(member));
}

void SchemaFields::number(const char* name, const std::optional<double>&, const Range& range, const char* doc)
{
    put(name, told(within(range), doc));
}

void SchemaFields::boolean(const char* name, bool value, const char* doc)
{
    put(name, told({{"type", "boolean"}, {"default", value}}, doc));
}

void SchemaFields::point(const char* name, const renderer::Vec3d& value, const char* doc)
{
    put(name, numbers(kCoordinate, 3, Json::array({value.x, value.y, value.z}), doc));
}

void SchemaFields::direction(const char* name, const renderer::Vec3d& value, const char* doc)
{
    Json member = numbers(kCoordinate, 3, Json::array({value.x, value.y, value.z}), doc);
    member["not"] = {{"const", Json::array({0, 0, 0})}};
    put(name, std::move(member));
}

void SchemaFields::color(const char* name, const renderer::Rgb& value, const Range& range, const char* doc)
{
    const Json standard =
        Json::array({shortest_double(value.r), shortest_double(value.g), shortest_double(value.b)});
    put(name, numbers(range, 3, standard, doc));
}

void SchemaFields::table(const char* name, const std::vector<renderer::NamedMaterial>&, const char* doc)
{
    put(name,
        told({{"type", "object"},
              {"propertyNames", text_schema(1, kLongestName)},
              {"additionalProperties", schema_of(renderer::Material{})}},
             doc));
}

void SchemaFields::needs(std::initializer_list<const char*> names)
{
    for (const char* name : names)
        schema_["required"].push_back(name);
}

void SchemaFields::exclude(const char* a, const char* b, const char*)
{
    schema_["allOf"].push_back({{"not", {{"required", Json::array({a, b})}}}});
}

void SchemaFields::aim(const renderer::CameraDescription& camera)
{
    point("look_at", camera.aim, "the point that is looked at");
    direction("direction", camera.aim, "the way that is looked, instead of look_at");
    schema_["properties"]["direction"].erase("default");
    exclude("look_at", "direction", nullptr);
}

void SchemaFields::sun_angles(const renderer::Vec3d&)
{
    number("elevation_deg",
           std::optional<double>{},
           kElevation,
           "of the sun over the horizon, instead of direction");
    number("azimuth_deg", std::optional<double>{}, kTurn, "of the sun, from -z towards +x");
    exclude("direction", "elevation_deg", nullptr);
    exclude("direction", "azimuth_deg", nullptr);
}

void SchemaFields::geometry(const renderer::Shape& shape)
{
    if (std::holds_alternative<renderer::MeshShape>(shape)) {
        put("mesh",
            told(text_schema(1, kLongestName),
                 "name of a file (of `files` or a multipart part), or a digest, sha256:..."));
        put("part", told(text_schema(1, kLongestName), "one named node of the mesh; left out: all of it"));
        return needs({"mesh"});
    }
    put("shape", {{"const", name_of(words_for<renderer::Shape>(), static_cast<int>(shape.index()))}});
    needs({"shape"});
    std::visit([this](const auto& alternative) { fields(*this, alternative); }, shape);
}

void SchemaFields::image_of(std::uint32_t)
{
    put("image",
        told(text_schema(1, kLongestName),
             "name of a picture (of `files` or a multipart part), or a digest, sha256:..."));
}

void SchemaFields::material_of(const std::optional<std::uint32_t>&)
{
    put("material",
        told(text_schema(1, kLongestName),
             "name in materials; left out: the mesh's own, else a default diffuse"));
}

void SchemaFields::metal_of(const std::variant<renderer::Metal, renderer::ComplexIor>& ior)
{
    word("metal", std::get<renderer::Metal>(ior), "by name; eta and k are measured ones");
    put("eta", numbers(kIor, 3, nullptr, "real part of the index of refraction, instead of a name"));
    put("k", numbers(kExtinction, 3, nullptr, "imaginary part of the index of refraction"));
    exclude("metal", "eta", nullptr);
    exclude("metal", "k", nullptr);
    schema_["dependentRequired"] = {{"eta", Json::array({"k"})}, {"k", Json::array({"eta"})}};
}

void SchemaFields::placement(const renderer::Affine3&)
{
    Json scale{{"oneOf", Json::array({within(kCoordinate), numbers(kCoordinate, 3, nullptr, nullptr)})}};
    Json axis = numbers(kCoordinate, 3, nullptr, "turned about, right-handed");
    axis["not"] = {{"const", Json::array({0, 0, 0})}};
    const auto step = [](Json properties, Json required) {
        return Json{{"type", "object"},
                    {"properties", std::move(properties)},
                    {"required", std::move(required)},
                    {"additionalProperties", false}};
    };
    const Json steps = Json::array(
        {step({{"scale", scale}}, Json::array({"scale"})),
         step({{"rotate_deg", within(kTurn)}, {"axis", axis}}, Json::array({"rotate_deg", "axis"})),
         step({{"translate", numbers(kCoordinate, 3, nullptr, nullptr)}}, Json::array({"translate"}))});
    put("transform", told({{"type", "array"}, {"items", {{"oneOf", steps}}}}, "steps, applied in order"));
    const Json identity = Json::array({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    put("matrix", numbers(kCoordinate, 16, identity, "row-major, points are columns; last row 0 0 0 1"));
    exclude("transform", "matrix", nullptr);
}

void SchemaFields::files(const std::map<std::string, std::string>&)
{
    put("files",
        told({{"type", "object"},
              {"propertyNames", text_schema(1, kLongestName)},
              {"additionalProperties", {{"type", "string"}, {"pattern", "^sha256:[0-9a-f]{64}$"}}}},
             "name -> digest: the only names that resolve; a multipart request adds its parts"));
}

void SchemaFields::labels(const std::map<std::string, std::string>&)
{
    Json name = text_schema(1, kLongestName);
    name["pattern"] = R"(^[^:\u0000-\u001f\u007f]*$)";
    put("labels",
        told({{"type", "object"},
              {"maxProperties", kMostLabels},
              {"propertyNames", name},
              {"additionalProperties", text_schema(0, kLongestLabel)}},
             "the client's own words, to find jobs by: ?label=name:value"));
}

void SchemaFields::fail_on(const std::vector<std::string>&)
{
    put("fail_on",
        told({{"type", "array"}, {"uniqueItems", true}, {"items", {{"enum", names_of(fail_on_words())}}}},
             "what makes the job fail instead of being told in the report"));
}

void SchemaFields::layers(renderer::LayerSet)
{
    std::string doc =
        "what is kept beside the picture, of the first thing that each camera ray hits, glass and "
        "mirrors themselves";
    for (const renderer::LayerEntry& entry : renderer::kLayers)
        doc.append("; ").append(entry.name).append(": ").append(entry.what);
    Json member =
        told({{"type", "array"}, {"uniqueItems", true}, {"items", {{"enum", names_of(layer_words())}}}},
             doc.c_str());
    member["default"] = Json::array();
    put("layers", std::move(member));
}

Json SchemaFields::schema_of(const renderer::ObjectDescription& object)
{
    Json any = Json::array();
    const auto add = [&](renderer::Shape shape) {
        renderer::ObjectDescription one = object;
        one.shape = std::move(shape);
        SchemaFields child;
        fields(child, one);
        any.push_back(std::move(child).schema());
    };
    add(renderer::MeshShape{});
    add(renderer::RectangleShape{});
    add(renderer::DiskShape{});
    add(renderer::BoxShape{});
    add(renderer::SphereShape{});
    return {{"oneOf", std::move(any)}};
}

void SchemaFields::coefficients(const char* name,
                                const std::vector<double>& values,
                                const Range& range,
                                const char* doc)
{
    Json list{{"type", "array"},
              {"items", within(range)},
              {"minItems", 1},
              {"maxItems", renderer::kMostWavelengths}};
    Json member{{"oneOf", Json::array({within(range), std::move(list)})}};
    if (!values.empty()) member["default"] = values;
    put(name, told(std::move(member), doc));
}

Json SchemaFields::typed(Json schema, std::string_view type)
{
    schema["properties"]["type"] = {{"const", type}};
    schema["required"].push_back("type");
    return schema;
}

Json SchemaFields::told(Json schema, const char* doc)
{
    if (doc) schema["description"] = doc;
    return schema;
}

Json SchemaFields::numbers(const Range& range, std::size_t count, Json standard, const char* doc)
{
    Json schema{{"type", "array"}, {"items", within(range)}, {"minItems", count}, {"maxItems", count}};
    if (!standard.is_null()) schema["default"] = std::move(standard);
    return told(std::move(schema), doc);
}

Json SchemaFields::whole(const WholeRange& range, const char* doc)
{
    Json schema{{"type", "integer"}, {"minimum", range.min}};
    if (!range.limit) schema["maximum"] = range.max;
    std::string text = doc;
    if (range.limit) text += std::string("; at most the limit ") + range.limit;
    return told(std::move(schema), text.c_str());
}

Json SchemaFields::one_of(WordTable words, std::string_view standard, const char* doc)
{
    return told({{"enum", names_of(words)}, {"default", standard}}, doc);
}

Json SchemaFields::within(const Range& range)
{
    return {{"type", "number"},
            {range.without_min ? "exclusiveMinimum" : "minimum", range.min},
            {range.without_max ? "exclusiveMaximum" : "maximum", range.max}};
}

void SchemaFields::or_texture(const char* name)
{
    Json value = std::move(schema_["properties"][name]);
    Json member = Json::object();
    for (const char* said : {"description", "default"})
        if (value.contains(said)) {
            member[said] = std::move(value[said]);
            value.erase(said);
        }
    member["oneOf"] = Json::array({std::move(value), schema_of(renderer::TextureUse{})});
    put(name, std::move(member));
}

void SchemaFields::put(const char* name, Json member)
{
    schema_["properties"][name] = std::move(member);
}

} // namespace api
