// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/camera/image_list.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::localize {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ImageList : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void put(const std::string& name, const std::string& text = "x") {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    std::ofstream(path(name), std::ios::binary) << text;
  }
  Outcome<std::vector<ListedImage>> read(const std::string& text) {
    put("rgb.txt", text);
    return read_image_list(path("rgb.txt"));
  }
  std::string refusal(const std::string& text) {
    const auto list = read(text);
    EXPECT_FALSE(list);
    return list ? "" : list.error().message;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(ImageList, HasStampsToTheNanosecondAndFilesOfItsFolder) {
  put("rgb/a.jpg");
  put("rgb/b.jpg");
  const auto list = read(
      "# timestamp filename\n1718021600.500000 rgb/a.jpg\n"
      "1718021601000000001 rgb/b.jpg\n");
  ASSERT_TRUE(list) << list.error().message;
  ASSERT_EQ(list->size(), 2U);
  EXPECT_EQ((*list)[0].stamp_ns, 1'718'021'600'500'000'000);
  EXPECT_EQ((*list)[0].file, path("rgb/a.jpg"));
  EXPECT_EQ((*list)[1].stamp_ns, 1'718'021'601'000'000'001);
}

TEST_F(ImageList, TakesOtherLineEndsHeadersAndSeparators) {
  put("a.jpg");
  put("b b.jpg");
  const auto list = read(
      "\xEF\xBB\xBFtimestamp,filename\r\n\r\n% note\r\n1.0,a.jpg\r\n"
      "2.0\tb b.jpg\r\n");
  ASSERT_TRUE(list) << list.error().message;
  ASSERT_EQ(list->size(), 2U);
  EXPECT_EQ((*list)[1].file, path("b b.jpg"));
}

TEST_F(ImageList, TakesTheFirstFileOfAssociatedImages) {
  put("rgb/a.png");
  const auto list = read("1.0 rgb/a.png 1.01 depth/a.png\n");
  ASSERT_TRUE(list) << list.error().message;
  EXPECT_EQ((*list)[0].file, path("rgb/a.png"));
}

TEST_F(ImageList, NeedsRisingStamps) {
  put("a.jpg");
  EXPECT_THAT(refusal("1 a.jpg\n2 a.jpg\n2 a.jpg\n"),
              AllOf(HasSubstr("rgb.txt:3: its stamp 2 does not rise"), HasSubstr("sort the list")));
}

TEST_F(ImageList, NamesWhatIsMissing) {
  put("a.jpg");
  EXPECT_THAT(refusal("1 a.jpg\n2 b.jpg\n3 c.jpg\n4 d.jpg\n5 e.jpg\n"),
              AllOf(HasSubstr("4 files of 5 are missing: " + path("b.jpg")),
                    HasSubstr(path("d.jpg") + " …"), testing::Not(HasSubstr("e.jpg"))));
}

TEST_F(ImageList, NamesALineThatIsNoRecord) {
  put("a.jpg");
  EXPECT_THAT(refusal("1 a.jpg\nx a.jpg\n"), HasSubstr("rgb.txt:2: \"x\" is not a stamp"));
  EXPECT_THAT(refusal("1\n"), HasSubstr("rgb.txt:1: names no file"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("lists no image"));
  EXPECT_THAT(refusal("1 " + std::string(9000, 'a')), HasSubstr("rgb.txt:1: is longer than"));
}

TEST_F(ImageList, IsNoFolderAndNoMissingFile) {
  EXPECT_THAT(read_image_list(folder_.path().string()).error().message, HasSubstr("is a folder"));
  EXPECT_THAT(read_image_list(path("none.txt")).error().message, HasSubstr("No such file"));
}

TEST_F(ImageList, OfAFolderWithoutListComesFromTheNames) {
  put("2.5.jpg");
  put("1.25.PNG");
  put("notes.txt");
  put("cover.jpg");
  const auto list = list_image_folder(folder_.path().string());
  ASSERT_TRUE(list) << list.error().message;
  ASSERT_EQ(list->size(), 2U);
  EXPECT_EQ((*list)[0].stamp_ns, 1'250'000'000);
  EXPECT_EQ((*list)[1].stamp_ns, 2'500'000'000);
}

TEST_F(ImageList, OfAFolderWithoutStampsSaysWhatItExpects) {
  put("cover.jpg");
  EXPECT_THAT(list_image_folder(folder_.path().string()).error().message,
              AllOf(HasSubstr("1 image with other names"), HasSubstr("expected DIR/rgb.txt")));
  EXPECT_THAT(list_image_folder(path("none")).error().message, HasSubstr("No such file"));
}

}  // namespace
}  // namespace zonepack::localize
