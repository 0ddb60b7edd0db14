#include "renderer/film/encode_jpeg.h"

#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <stdexcept>
#include <string>

// Needs FILE and size_t before it.
#include <jerror.h>
#include <jpeglib.h>

namespace renderer {

namespace {

constexpr int kQuality = 92;
constexpr std::size_t kBufferBytes = 1u << 16;
constexpr std::size_t kMostComment = 65533; // of the format

// The library's structs with what its callbacks need. All of it is plain: an error leaves by longjmp.
struct Encoder {
    jpeg_compress_struct jpeg{}; // first: the callbacks are given this alone
    jpeg_error_mgr errors{};
    jpeg_destination_mgr destination{};
    std::jmp_buf on_error{};
    std::array<JOCTET, kBufferBytes> buffer{};
    std::vector<std::uint8_t>* bytes = nullptr;
    bool out_of_memory = false;
};

Encoder& encoder_of(j_common_ptr jpeg)
{
    return *static_cast<Encoder*>(jpeg->client_data);
}

Encoder& encoder_of(j_compress_ptr jpeg)
{
    return *static_cast<Encoder*>(jpeg->client_data);
}

[[noreturn]] void leave(j_common_ptr jpeg)
{
    std::longjmp(encoder_of(jpeg).on_error, 1);
}

void say_nothing(j_common_ptr /*jpeg*/) {}

void begin(j_compress_ptr jpeg)
{
    jpeg->dest->next_output_byte = encoder_of(jpeg).buffer.data();
    jpeg->dest->free_in_buffer = kBufferBytes;
}

// No exception may pass through the library.
void take(Encoder& encoder, std::size_t count)
{
    try {
        encoder.bytes->insert(
            encoder.bytes->end(), encoder.buffer.begin(), encoder.buffer.begin() + static_cast<int>(count));
    } catch (const std::bad_alloc&) {
        encoder.out_of_memory = true;
    }
}

// The whole buffer counts, whatever free_in_buffer says.
boolean take_full(j_compress_ptr jpeg)
{
    Encoder& encoder = encoder_of(jpeg);
    take(encoder, kBufferBytes);
    if (encoder.out_of_memory) std::longjmp(encoder.on_error, 1);
    begin(jpeg);
    return TRUE;
}

void take_rest(j_compress_ptr jpeg)
{
    Encoder& encoder = encoder_of(jpeg);
    take(encoder, kBufferBytes - jpeg->dest->free_in_buffer);
    if (encoder.out_of_memory) std::longjmp(encoder.on_error, 1);
}

void prepare(Encoder& encoder, std::vector<std::uint8_t>& bytes)
{
    jpeg_compress_struct& jpeg = encoder.jpeg;
    encoder.bytes = &bytes;
    jpeg.err = jpeg_std_error(&encoder.errors);
    jpeg.client_data = &encoder;
    encoder.errors.error_exit = leave;
    encoder.errors.output_message = say_nothing;
    encoder.destination.init_destination = begin;
    encoder.destination.empty_output_buffer = take_full;
    encoder.destination.term_destination = take_rest;
}

// Nothing here has a destructor. False: see encoder.
bool write(Encoder& encoder, const Image8& image, const std::string* comments, std::size_t comment_count)
{
    jpeg_compress_struct& jpeg = encoder.jpeg;
    if (setjmp(encoder.on_error) != 0) return false;
    jpeg_create_compress(&jpeg);
    jpeg.dest = &encoder.destination;
    jpeg.image_width = image.width_px;
    jpeg.image_height = image.height_px;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, kQuality, TRUE);
    jpeg.dct_method = JDCT_ISLOW;
    for (int i = 0; i < jpeg.num_components; ++i)
        jpeg.comp_info[i].h_samp_factor = jpeg.comp_info[i].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    for (std::size_t i = 0; i < comment_count; ++i)
        jpeg_write_marker(&jpeg,
                          JPEG_COM,
                          reinterpret_cast<const JOCTET*>(comments[i].data()),
                          static_cast<unsigned>(comments[i].size()));
    const std::size_t row_bytes = std::size_t{image.width_px} * 3;
    while (jpeg.next_scanline < jpeg.image_height) {
        // The library reads rows, but its type does not say so.
        auto* row = const_cast<JSAMPROW>(image.rgb.data() + jpeg.next_scanline * row_bytes);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

} // namespace

std::vector<std::uint8_t> encode_jpeg(const Image8& image, const PictureTexts& texts)
{
    std::vector<std::string> comments;
    for (const PictureText& text : texts)
        comments.push_back((text.keyword + ": " + text.text).substr(0, kMostComment));
    std::vector<std::uint8_t> bytes;
    Encoder encoder;
    prepare(encoder, bytes);
    const bool done = write(encoder, image, comments.data(), comments.size());
    std::string why(JMSG_LENGTH_MAX, '\0');
    if (!done && !encoder.out_of_memory)
        encoder.errors.format_message(reinterpret_cast<j_common_ptr>(&encoder.jpeg), why.data());
    const bool library_out_of_memory = !done && encoder.errors.msg_code == JERR_OUT_OF_MEMORY;
    jpeg_destroy_compress(&encoder.jpeg);
    if (done) return bytes;
    if (encoder.out_of_memory || library_out_of_memory) throw std::bad_alloc();
    throw std::runtime_error("cannot encode the picture as JPEG: " + std::string(why.c_str()));
}

} // namespace renderer
