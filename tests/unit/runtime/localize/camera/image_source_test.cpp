// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_source.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "platform/process/clock.hpp"
#include "platform/process/local_socket.hpp"
#include "runtime/localize/camera/folder_source.hpp"
#include "runtime/localize/camera/socket_source.hpp"
#include "runtime/localize/camera/video_source.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/runtime/localize/made_images.hpp"

namespace zonepack::localize {
namespace {

using State = ImageSource::State;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

CameraModel camera_of(int width, int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  return camera;
}

TEST(CameraChoiceText, NamesAFolderWithItsSpeedASocketOrADevice) {
  const auto folder = parse_camera("folder:/data/a@b/rgb@2.5");
  ASSERT_TRUE(folder);
  EXPECT_EQ(folder->place, "/data/a@b/rgb");
  EXPECT_EQ(folder->speed, 2.5);
  EXPECT_EQ(parse_camera("folder:rgb")->speed, 1);
  EXPECT_EQ(parse_camera("socket:/run/cam@1.sock")->place, "/run/cam@1.sock");
  EXPECT_EQ(parse_camera("v4l2:/dev/video0")->kind, CameraChoice::Kind::kVideo);
}

TEST(CameraChoiceText, SaysWhatItExpects) {
  for (const char* text : {"", "/dev/video0", "v4l2:", "folder:", "folder:a@", "folder:a@0",
                           "folder:a@nan", "folder:a@-1", "usb:1"}) {
    const auto choice = parse_camera(text);
    ASSERT_FALSE(choice) << text;
    EXPECT_EQ(choice.error().code, ErrorCode::kUsage);
    EXPECT_THAT(choice.error().message, HasSubstr("v4l2:DEV, socket:PATH, folder:DIR")) << text;
  }
}

// --- a folder, in a run's time that the test sets ---

class FolderImages : public testing::Test {
 protected:
  void put(const char* name) {
    const Bytes bytes = make_png();
    std::ofstream((folder_.path() / name).string(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  std::unique_ptr<ImageSource> open() {
    auto source = open_camera({CameraChoice::Kind::kFolder, folder_.path().string(), 1},
                              camera_of(16, 8), [this] { return now_ns_; });
    EXPECT_TRUE(source) << source.error().message;
    return source ? std::move(source).value() : nullptr;
  }

  test_support::TemporaryFolder folder_;
  std::int64_t now_ns_ = 10 * kSecond_ns;
  GreyImage image_;
};

TEST_F(FolderImages, ComeWhenTheRunsClockReachesTheirStamps) {
  put("10.5.png");
  put("11.png");
  const auto source = open();
  EXPECT_EQ(source->next(0, image_).state, State::kNothing);
  now_ns_ = 10'500'000'000;
  EXPECT_EQ(source->next(0, image_).state, State::kImage);
  EXPECT_EQ(image_.stamp_ns, 10'500'000'000);
  EXPECT_EQ(source->next(0, image_).state, State::kNothing);
  now_ns_ = 12 * kSecond_ns;
  EXPECT_EQ(source->next(0, image_).state, State::kImage);
  EXPECT_EQ(source->next(0, image_).state, State::kDone);
}

// At 12.2 s those of 10.5 and 11 were due as well: the newest is given, two were skipped.
TEST_F(FolderImages, AreSkippedWhileTheCallerIsBusy) {
  for (const char* name : {"10.png", "10.5.png", "11.png", "12.png", "13.png"}) put(name);
  const auto source = open();
  EXPECT_EQ(source->next(0, image_).state, State::kImage);
  now_ns_ = 12'200'000'000;
  const auto news = source->next(0, image_);
  EXPECT_EQ(news.state, State::kImage);
  EXPECT_EQ(news.skipped, 2U);
  EXPECT_EQ(image_.stamp_ns, 12 * kSecond_ns);
}

TEST_F(FolderImages, FromBeforeTheStartArePassedOver) {
  for (const char* name : {"8.png", "9.png", "10.5.png"}) put(name);
  const auto source = open();
  EXPECT_EQ(source->next(0, image_).state, State::kNothing);
}

TEST_F(FolderImages, OfAnotherDayAreRefusedByName) {
  put("1718021600.5.png");
  const auto news = open()->next(0, image_);
  EXPECT_EQ(news.state, State::kBroken);
  EXPECT_THAT(news.why, AllOf(HasSubstr("from 1718021600.500 to 1718021600.500 s"),
                              HasSubstr("zoned's clock is at 10.000 s")));
}

TEST_F(FolderImages, ThatAreDamagedAreRefusedAndTheNextComes) {
  std::ofstream((folder_.path() / "10.1.jpg").string()) << "\xFF\xD8\xFF damaged";
  put("10.2.png");
  const auto source = open();
  now_ns_ = 10'100'000'000 - 1;
  EXPECT_EQ(source->next(0, image_).state, State::kNothing);
  now_ns_ = 10'150'000'000;
  const auto news = source->next(0, image_);
  EXPECT_EQ(news.state, State::kRefused);
  EXPECT_THAT(news.why, HasSubstr("10.1.jpg: is a JPEG that"));
  now_ns_ = 10'250'000'000;
  EXPECT_EQ(source->next(0, image_).state, State::kImage);
}

// --- a socket ---

struct Head {
  std::uint32_t bytes = 128, width = 16, height = 8, row_bytes = 16;
  std::uint8_t format = 0, clock = 1;
  std::uint16_t zero = 0;
  std::int64_t stamp_ns = 77;

  Bytes packet(const char* magic = "ZPI1") const {
    Bytes all(32);
    std::memcpy(all.data(), magic, 4);
    std::memcpy(all.data() + 4, &bytes, 4);  // the tests run on little-endian machines
    std::memcpy(all.data() + 8, &width, 4);
    std::memcpy(all.data() + 12, &height, 4);
    std::memcpy(all.data() + 16, &row_bytes, 4);
    std::memcpy(all.data() + 20, &format, 1);
    std::memcpy(all.data() + 21, &clock, 1);
    std::memcpy(all.data() + 22, &zero, 2);
    std::memcpy(all.data() + 24, &stamp_ns, 8);
    return all;
  }
};

class SocketImages : public testing::Test {
 protected:
  void SetUp() override {
    auto source = SocketSource::open(path_, 16, 8);
    ASSERT_TRUE(source) << source.error().message;
    source_ = std::move(source).value();
    writer_ = connect();
  }
  LocalSocket connect() {
    auto socket = LocalSocket::connect(path_);
    EXPECT_TRUE(socket);
    return std::move(socket).value();
  }
  void send(const Bytes& bytes) { ASSERT_TRUE(writer_.send(bytes)); }
  void send_image(const Head& head, std::byte value = std::byte{9}) {
    send(head.packet());
    send(Bytes(head.bytes, value));
  }
  ImageSource::News next(std::int64_t wait_ns = 20'000'000) {
    return source_->next(monotonic_ns() + wait_ns, image_);
  }
  // What the writer reads before it is disconnected.
  std::string last_words() {
    Bytes buffer(1000);
    writer_.wait(false, 1000);
    const auto got = writer_.receive(buffer);
    if (!got || got->bytes == 0) return {};
    return {reinterpret_cast<const char*>(buffer.data()), got->bytes};
  }
  void expect_refused(const Bytes& packet, const char* why) {
    send(packet);
    const auto news = next();
    EXPECT_EQ(news.state, State::kRefused);
    EXPECT_THAT(news.why, HasSubstr(why));
    EXPECT_THAT(last_words(), HasSubstr(why));
    EXPECT_EQ(next().state, State::kNothing);
    writer_ = connect();
  }

  test_support::TemporaryFolder folder_;
  const std::string path_ = (folder_.path() / "camera.sock").string();
  std::unique_ptr<ImageSource> source_;
  LocalSocket writer_;
  GreyImage image_;
};

TEST_F(SocketImages, ArriveWithStampAndClock) {
  Head head;
  head.clock = 2;
  send_image(head);
  EXPECT_EQ(next().state, State::kImage);
  EXPECT_EQ(image_.stamp_ns, 77);
  EXPECT_EQ(source_->clock(), ImageClock::kRealtime);
  ASSERT_TRUE(image_.whole());
  EXPECT_THAT(image_.pixels, testing::Each(9));
}

// Of rows of 20 bytes the last 4 are padding.
TEST_F(SocketImages, MayHavePaddedRows) {
  Head head;
  head.row_bytes = 20;
  head.bytes = 160;
  Bytes pixels(160, std::byte{1});
  for (std::size_t i = 0; i < 160; ++i) {
    if (i % 20 >= 16) pixels[i] = std::byte{200};
  }
  send(head.packet());
  send(pixels);
  EXPECT_EQ(next().state, State::kImage);
  EXPECT_THAT(image_.pixels, testing::Each(1));
}

TEST_F(SocketImages, MayBeJpegs) {
  const Bytes jpeg = make_jpeg();
  Head head;
  head.format = 4;
  head.row_bytes = 0;
  head.bytes = static_cast<std::uint32_t>(jpeg.size());
  send(head.packet());
  send(jpeg);
  EXPECT_EQ(next().state, State::kImage);
  EXPECT_TRUE(image_.whole());
}

TEST_F(SocketImages, MayComeInPieces) {
  send(Head().packet());
  send(Bytes(100, std::byte{3}));
  EXPECT_EQ(next().state, State::kNothing);
  send(Bytes(28, std::byte{3}));
  EXPECT_EQ(next().state, State::kImage);
}

TEST_F(SocketImages, AreSkippedWhenANewerOneWaits) {
  Head head;
  for (head.stamp_ns = 1; head.stamp_ns <= 3; ++head.stamp_ns) send_image(head);
  const auto news = next();
  EXPECT_EQ(news.state, State::kImage);
  EXPECT_EQ(news.skipped, 2U);
  EXPECT_EQ(image_.stamp_ns, 3);
}

TEST_F(SocketImages, OfAnotherSizeAreRefused) {
  Head head;
  head.width = 640;
  expect_refused(head.packet(), "an image of 640x8; the calibration is of 16x8");
}

// 4 GiB are promised; nothing is taken.
TEST_F(SocketImages, ThatPromiseTooMuchAreRefused) {
  Head head;
  head.bytes = 0xFFFFFFFF;
  head.row_bytes = 0x20000000;
  expect_refused(head.packet(), "4294967295 bytes");
  head.format = 4;
  expect_refused(head.packet(), "expected 1 to 66048");  // 4 * 16 * 8 + 65536
}

TEST_F(SocketImages, WithoutAHeaderAreRefused) {
  expect_refused(Head().packet("GET "), "begins with ZPI1");
  expect_refused(Bytes(31), "got 31 bytes");
  Head head;
  head.format = 5;
  expect_refused(head.packet(), "format 5");
  head = {};
  head.clock = 3;
  expect_refused(head.packet(), "clock 3");
  head = {};
  head.row_bytes = 15;
  head.bytes = 120;
  expect_refused(head.packet(), "rows of 16 or more");
}

TEST_F(SocketImages, WithMoreBytesThanTheirHeaderSaysAreRefused) {
  send(Head().packet());
  expect_refused(Bytes(129), "more bytes than");
}

TEST_F(SocketImages, MayNotComeInPacketsOverTheLimit) {
  send(Head().packet());
  expect_refused(Bytes(65'537), "more than 65536");
}

TEST_F(SocketImages, ThatStopInTheMiddleAreRefusedAfterASecond) {
  send(Head().packet());
  send(Bytes(100));
  const auto news = next(2 * kSecond_ns);
  EXPECT_EQ(news.state, State::kRefused);
  EXPECT_THAT(news.why, HasSubstr("nothing for 1 s"));
}

TEST_F(SocketImages, OfAWriterThatLeavesAreForgotten) {
  send(Head().packet());
  EXPECT_EQ(next().state, State::kNothing);
  writer_.close();
  EXPECT_THAT(next().why, HasSubstr("closed in the middle"));
  writer_ = connect();
  send_image({});
  EXPECT_EQ(next().state, State::kImage);
}

TEST_F(SocketImages, ComeFromOneWriterAtATime) {
  send_image({});
  EXPECT_EQ(next().state, State::kImage);
  LocalSocket other = connect();
  EXPECT_EQ(next().state, State::kNothing);
  std::swap(other, writer_);
  EXPECT_EQ(last_words(), "another program writes images here");
  std::swap(other, writer_);
  send_image({});
  EXPECT_EQ(next().state, State::kImage);
}

TEST_F(SocketImages, NeedAPlaceOfTheirOwn) {
  EXPECT_THAT(SocketSource::open(path_, 16, 8).error().message,
              HasSubstr("another program listens there"));
  EXPECT_THAT(SocketSource::open("/nonexistent/a.sock", 16, 8).error().message,
              HasSubstr("/nonexistent/a.sock: cannot be made"));
}

// --- a camera ---

class FakeCamera final : public VideoDevice {
 public:
  Result<VideoFrame> answer = ErrorCode::kBusy;
  Result<VideoFrame> next(std::int64_t) noexcept override { return answer; }
};

class CameraImages : public testing::Test {
 protected:
  ImageSource::News next() { return source_.next(0, image_); }
  VideoFrame frame(VideoFormat format, std::uint32_t row_bytes, ByteSpan bytes) {
    VideoFrame frame;
    frame.format = format;
    frame.width = 16;
    frame.height = 8;
    frame.row_bytes = row_bytes;
    frame.bytes = bytes;
    frame.stamp_ns = 5;
    return frame;
  }

  FakeCamera* camera_ = new FakeCamera;  // the source owns it
  VideoSource source_{"/dev/video0", std::unique_ptr<VideoDevice>(camera_)};
  GreyImage image_;
};

TEST_F(CameraImages, AreMadeGrey) {
  Bytes yuyv(256, std::byte{128});
  for (std::size_t i = 0; i < yuyv.size(); i += 2) yuyv[i] = std::byte{40};
  camera_->answer = frame(VideoFormat::kYuyv, 32, yuyv);
  EXPECT_EQ(next().state, State::kImage);
  EXPECT_EQ(image_.stamp_ns, 5);
  EXPECT_THAT(image_.pixels, testing::Each(40));
  const Bytes jpeg = make_jpeg();
  camera_->answer = frame(VideoFormat::kMjpeg, 0, jpeg);
  EXPECT_EQ(next().state, State::kImage);
}

TEST_F(CameraImages, ThatAreShortDamagedOrOfAnotherSizeAreRefused) {
  const Bytes grey(127);
  camera_->answer = frame(VideoFormat::kGrey, 16, grey);
  EXPECT_THAT(next().why, HasSubstr("/dev/video0: an image of 16x8 has 127 bytes; expected 128"));
  VideoFrame damaged = frame(VideoFormat::kGrey, 16, grey);
  damaged.damaged = true;
  camera_->answer = damaged;
  EXPECT_THAT(next().why, HasSubstr("damaged"));
  MadeJpeg other;
  other.width = 8;
  const Bytes jpeg = make_jpeg(other);
  camera_->answer = frame(VideoFormat::kMjpeg, 0, jpeg);
  EXPECT_THAT(next().why, HasSubstr("its JPEG is 8x8 pixels; expected 16x8"));
}

TEST_F(CameraImages, EndWhenTheCameraIsUnplugged) {
  EXPECT_EQ(next().state, State::kNothing);
  camera_->answer = ErrorCode::kNotFound;
  const auto news = next();
  EXPECT_EQ(news.state, State::kBroken);
  EXPECT_THAT(news.why, HasSubstr("unplugged"));
}

}  // namespace
}  // namespace zonepack::localize
