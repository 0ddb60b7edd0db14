// SchemaFields: the visitor that writes the JSON Schema of a struct of the job: types, ranges, defaults,
// meanings.
//
// It visits a default-made struct: what stands there is the default. Limits of a service are not in the
// schema, since they differ: /v1/capabilities has them. What is not built is not in it either.
#pragma once

#include "api/fields/ranges.h"
#include "api/job_request.h"
#include "api/json/json.h"
#include "api/words/word_table.h"
#include "renderer/description/layers.h"
#include "renderer/description/texture.h"

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace api {

class SchemaFields {
public:
    SchemaFields();
    Json schema() &&; // the object's

    void number(const char* name, double value, const Range& range, const char* doc);
    void number(const char* name, const std::optional<double>& value, const Range& range, const char* doc);
    template <std::integral T>
    void integer(const char* name, T value, const WholeRange& range, const char* doc)
    {
        // A default outside its range stands for "must be given".
        Json member = whole(range, doc);
        if (static_cast<std::uint64_t>(value) >= range.min) member["default"] = value;
        put(name, std::move(member));
    }
    template <std::integral T>
    void integer(const char* name, const std::optional<T>&, const WholeRange& range, const char* doc)
    {
        put(name, whole(range, doc));
    }
    void boolean(const char* name, bool value, const char* doc);
    template <typename E>
    void word(const char* name, E value, const char* doc)
    {
        const WordTable words = words_for<E>();
        put(name, one_of(words, name_of(words, static_cast<int>(value)), doc));
    }
    template <typename E>
    void word(const char* name, const std::optional<E>&, const char* doc)
    {
        put(name, told({{"enum", names_of(words_for<E>())}}, doc));
    }
    void point(const char* name, const renderer::Vec3d& value, const char* doc);
    void direction(const char* name, const renderer::Vec3d& value, const char* doc);
    void color(const char* name, const renderer::Rgb& value, const Range& range, const char* doc);
    void color(const char* name, const std::optional<renderer::Rgb>&, const Range& range, const char* doc)
    {
        put(name, numbers(range, 3, nullptr, doc));
    }
    void textured_color(const char* name,
                        const renderer::TexturedColor& value,
                        const Range& range,
                        const char* doc)
    {
        color(name, value.value, range, doc);
        or_texture(name);
    }
    void textured_number(const char* name,
                         const renderer::TexturedNumber& value,
                         const Range& range,
                         const char* doc)
    {
        number(name, value.value, range, doc);
        or_texture(name);
    }
    template <typename... D>
    void extents(const char* name, const char* doc, const D&... sizes)
    {
        put(name, numbers(kSize, sizeof...(D), Json::array({sizes...}), doc));
    }

    template <typename T>
    void object(const char* name, const T& value, const char* doc)
    {
        put(name, told(schema_of(value), doc));
    }
    template <typename T>
    void object(const char* name, const std::optional<T>&, const char* doc)
    {
        put(name, told(schema_of(T{}), doc));
    }
    template <typename Walk>
    void group(const char* name, const char* doc, const Walk& walk)
    {
        SchemaFields child;
        walk(child);
        put(name, told(std::move(child).schema(), doc));
    }
    template <typename V>
    void kinds(const char* name, const std::optional<V>&, const char* doc)
    {
        put(name, told(schema_of(V{}), doc));
    }
    template <typename T>
    void list(const char* name, const std::vector<T>&, const char*, const char* doc)
    {
        put(name, told({{"type", "array"}, {"items", schema_of(T{})}}, doc));
    }
    void table(const char* name, const std::vector<renderer::NamedMaterial>&, const char* doc);

    // Nothing by default: the preset's law.
    void
    coefficients(const char* name, const std::vector<double>& values, const Range& range, const char* doc);
    void preset(const char* name, const renderer::AtmosphereDescription& atmosphere, const char* doc)
    {
        word(name, atmosphere.preset, doc);
    }

    void unbuilt(std::initializer_list<const char*>, const char*) {}
    void needs(std::initializer_list<const char*> names);
    void exclude(const char* a, const char* b, const char* remedy);

    // The schema does not tell when: the reader does, and the member's meaning.
    template <typename Walk>
    void only_when(bool, std::initializer_list<const char*>, const char*, const Walk& walk)
    {
        walk();
    }

    void aim(const renderer::CameraDescription& camera);
    void sun_angles(const renderer::Vec3d& travels);
    void geometry(const renderer::Shape& shape);
    void image_of(std::uint32_t image);
    void material_of(const std::optional<std::uint32_t>& material);
    void metal_of(const std::variant<renderer::Metal, renderer::ComplexIor>& ior);
    void placement(const renderer::Affine3& world_from_object);
    void files(const std::map<std::string, std::string>& files);
    void labels(const std::map<std::string, std::string>& labels);
    void fail_on(const std::vector<std::string>& words);
    void layers(renderer::LayerSet layers);

    template <typename T>
    static Json schema_of(const T& value)
    {
        SchemaFields child;
        fields(child, value);
        return std::move(child).schema();
    }
    // One alternative each, told apart by `type`.
    template <typename... Ts>
    static Json schema_of(const std::variant<Ts...>&)
    {
        Json any = Json::array();
        const auto add = [&any](const auto& alternative, int index) {
            const WordTable words = words_for<std::variant<Ts...>>();
            const std::string_view name = name_of(words, index);
            if (find_word(words, name)->built()) any.push_back(typed(schema_of(alternative), name));
        };
        (add(Ts{}, kIndexIn<Ts, std::variant<Ts...>>), ...);
        return {{"oneOf", std::move(any)}};
    }
    // An object's members differ with its shape: one alternative each.
    static Json schema_of(const renderer::ObjectDescription&);

private:
    static Json typed(Json schema, std::string_view type);
    static Json told(Json schema, const char* doc);
    static Json numbers(const Range& range, std::size_t count, Json standard, const char* doc);
    static Json whole(const WholeRange& range, const char* doc);
    static Json one_of(WordTable words, std::string_view standard, const char* doc);
    static Json within(const Range& range);
    void put(const char* name, Json member);
    // What was put under `name` may be a texture instead.
    void or_texture(const char* name);

    Json schema_;
};

} // namespace api
