#include "scene/image_decode.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>
#include <png.h>
#include <webp/decode.h>

namespace sconce
{

namespace
{

using Bytes = std::span<const uint8_t>;

Error imageError(std::string_view name, const std::string& what)
{
    return {ErrorCode::badInput, fmt::format("Image '{}' {}", name, what)};
}

// Empty when the size is acceptable.
std::string sizeFault(uint64_t width, uint64_t height)
{
    const std::string size = fmt::format("{}x{}", width, height);
    if (width == 0 || height == 0) return fmt::format("is {} pixels; give it a size.", size);
    if (width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImagePixels)
        return fmt::format("is {} pixels; the limit is {} a side and {} Mpixel, scale it down.", size, kMaxImageSide,
                           kMaxImagePixels >> 20);
    return {};
}

bool startsWith(Bytes bytes, std::string_view magic)
{
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

// Not inlined: no string of its own may live in a function that calls setjmp.
[[gnu::noinline]] void noteSizeFault(std::string& fault, const Image& image)
{
    fault = sizeFault(image.width, image.height);
}

// Everything that must outlive a longjmp lives here, outside the function that calls setjmp.
struct PngReader
{
    Bytes bytes;
    size_t at = 0;
    std::string fault;
    std::vector<png_bytep> rows;

    static void read(png_structp png, png_bytep out, size_t count)
    {
        auto& self = *static_cast<PngReader*>(png_get_io_ptr(png));
        if (count > self.bytes.size() - self.at) png_error(png, "the file ends too early");
        std::memcpy(out, self.bytes.data() + self.at, count);
        self.at += count;
    }
    static void fail(png_structp png, png_const_charp message)
    {
        static_cast<PngReader*>(png_get_error_ptr(png))->fault = fmt::format("can't be decoded as PNG ({}); export it again.", message);
        // The fault is kept first, outside of what the jump leaves: it must not return to libpng.
        png_longjmp(png, 1);
    }
    static void ignoreWarning(png_structp, png_const_charp) {}
};

void readPng(png_structp png, png_infop info, PngReader& reader, Image& image)
{
    if (setjmp(png_jmpbuf(png))) return; // reader.fault says why
    png_set_read_fn(png, &reader, PngReader::read);
    // Four times as wide as ours, so that a merely large image still reaches our check.
    png_set_user_limits(png, kMaxImageSide * 4, kMaxImageSide * 4); // ours is checked below, with a better sentence
    png_read_info(png, info);
    image.width = png_get_image_width(png, info);
    image.height = png_get_image_height(png, info);
    noteSizeFault(reader.fault, image);
    if (!reader.fault.empty()) return;
    png_set_expand(png); // palette, 1/2/4 bit grey and tRNS to 8 bit and alpha
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    // Asked of libpng, not assumed: it writes whole rows into memory that is sized here.
    if (png_get_rowbytes(png, info) != size_t(image.width) * 4) png_error(png, "unexpected pixel layout");
    image.rgba.resize(size_t(image.width) * image.height * 4);
    reader.rows.resize(image.height);
    for (uint32_t y = 0; y < image.height; ++y) reader.rows[y] = image.rgba.data() + size_t(y) * image.width * 4;
    png_read_image(png, reader.rows.data());
}

std::string decodePng(Bytes bytes, Image& image)
{
    PngReader reader;
    reader.bytes = bytes;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, PngReader::fail, PngReader::ignoreWarning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (info)
        readPng(png, info, reader, image);
    else
        reader.fault = "can't be decoded: libpng is out of memory; close other programs.";
    png_destroy_read_struct(&png, &info, nullptr);
    return reader.fault;
}

struct JpegReader
{
    jpeg_decompress_struct info{};
    jpeg_error_mgr errors{};
    std::jmp_buf escape;
    std::string fault;

    static void fail(j_common_ptr common)
    {
        char message[JMSG_LENGTH_MAX];
        common->err->format_message(common, message);
        auto& self = *static_cast<JpegReader*>(common->client_data);
        self.fault = fmt::format("can't be decoded as JPEG ({}); export it again.", message);
        std::longjmp(self.escape, 1);
    }
    // Warnings mean damaged data (a truncated file is only a warning to libjpeg): what it would make up is not what the author saw. But for
    // bytes between markers, and markers of a kind or version that it doesn't know: every viewer shows such files, whole.
    static void message(j_common_ptr common, int level)
    {
        const int code = common->err->msg_code;
        if (level < 0 && code != JWRN_EXTRANEOUS_DATA && code != JWRN_ADOBE_XFORM && code != JWRN_JFIF_MAJOR) fail(common);
    }
};

void readJpeg(JpegReader& reader, Bytes bytes, Image& image)
{
    if (setjmp(reader.escape)) return; // reader.fault says why
    jpeg_mem_src(&reader.info, bytes.data(), (unsigned long)bytes.size());
    jpeg_read_header(&reader.info, TRUE);
    image.width = reader.info.image_width;
    image.height = reader.info.image_height;
    noteSizeFault(reader.fault, image);
    if (reader.info.jpeg_color_space == JCS_CMYK || reader.info.jpeg_color_space == JCS_YCCK)
        reader.fault = "is a CMYK JPEG; convert it to RGB.";
    if (!reader.fault.empty()) return;
    reader.info.out_color_space = JCS_EXT_RGBA; // libjpeg-turbo fills alpha with 255
    jpeg_start_decompress(&reader.info);
    image.rgba.resize(size_t(image.width) * image.height * 4);
    while (reader.info.output_scanline < reader.info.output_height)
    {
        JSAMPROW row = image.rgba.data() + size_t(reader.info.output_scanline) * image.width * 4;
        jpeg_read_scanlines(&reader.info, &row, 1);
    }
    jpeg_finish_decompress(&reader.info);
}

std::string decodeJpeg(Bytes bytes, Image& image)
{
    JpegReader reader;
    reader.info.err = jpeg_std_error(&reader.errors);
    reader.errors.error_exit = JpegReader::fail;
    reader.errors.emit_message = JpegReader::message;
    reader.info.client_data = &reader;
    if (!setjmp(reader.escape)) jpeg_create_decompress(&reader.info);
    if (reader.fault.empty()) readJpeg(reader, bytes, image);
    jpeg_destroy_decompress(&reader.info);
    return reader.fault;
}

std::string decodeWebp(Bytes bytes, Image& image)
{
    int width = 0, height = 0;
    if (!WebPGetInfo(bytes.data(), bytes.size(), &width, &height)) return "has a damaged WebP header; export it again.";
    if (std::string fault = sizeFault(uint64_t(width), uint64_t(height)); !fault.empty()) return fault;
    image.width = uint32_t(width);
    image.height = uint32_t(height);
    image.rgba.resize(size_t(width) * size_t(height) * 4);
    if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(), width * 4))
        return "can't be decoded as WebP; export it again.";
    return {};
}

} // namespace

Result<Image> decodeImage(Bytes bytes, std::string_view name)
{
    Image image;
    image.name = std::string(name);
    std::string fault;
    if (startsWith(bytes, "\x89PNG\r\n\x1a\n"))
        fault = decodePng(bytes, image);
    else if (startsWith(bytes, "\xff\xd8\xff"))
        fault = decodeJpeg(bytes, image);
    else if (startsWith(bytes, "RIFF") && bytes.size() >= 12 && std::memcmp(bytes.data() + 8, "WEBP", 4) == 0)
        fault = decodeWebp(bytes, image);
    else if (startsWith(bytes, "\xabKTX 20\xbb"))
        fault = "is KTX2 (Basis Universal), which isn't supported; convert it to PNG, JPEG or WebP.";
    else
        fault = "is none of PNG, JPEG and WebP; convert it to one of them.";
    if (!fault.empty()) return imageError(name, fault);
    return image;
}

} // namespace sconce
