// The members of a texture: see job_fields.h.
#pragma once

#include "api/fields/ranges.h"
#include "api/fields/sees.h"
#include "renderer/description/texture.h"

namespace api {

template <typename V, Sees<renderer::TextureUse> X>
void fields(V& v, X& use)
{
    v.image_of(use.image);
    v.extents("scale", "how often the picture fits along u and v", use.scale_u, use.scale_v);
    v.word("wrap", use.wrap, "what is beyond the picture's edges");
    v.word("filter", use.filter, "linear: no more detail than a pixel can show; nearest: the texel itself");
    v.word("encoding",
           use.encoding,
           "of the picture's numbers; left out: srgb for colours of 8 or 16 bits, else linear");
    v.needs({"image"});
}

} // namespace api
