// Frames and mails as independent stacks put them on the wire, in hex: SOEM 2 and KickCAT against SOES devices with the
// dictionary of a Meca500 (soem2, kickcat), ethercrab against three of them, libethercat against KickCAT's simulator.
// "soem2, frame 259" names capture and frame.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "tests/hex.hpp"

namespace meca::ethercat::golden {

using meca::test::from_hex;

// ---- Frames, from the Ethernet header on

// soem2, frame 3: BWR AL control, to be sent.
inline constexpr std::string_view kAcknowledgeAndInit =
    "FF FF FF FF FF FF 01 01 01 01 01 01 88 A4 0E 10 08 02 00 00 20 01 02 00 00 00 11 00 00 00";

// soem2, frame 4: its reply.
inline constexpr std::string_view kAcknowledgeAndInitReply =
    "FF FF FF FF FF FF 03 01 01 01 01 01 88 A4 0E 10 08 02 01 00 20 01 02 00 00 00 11 00 01 00";

// kickcat, frame 416: two FPRD of mailbox status, padded.
inline constexpr std::string_view kMailboxStatusReply =
    "FF FF FF FF FF FF CA DE CA DE DE FF 88 A4 1A 10 04 7D E9 03 05 08 01 80 00 00 00 01 00 04 7E E9 "
    "03 0D 08 01 00 00 00 00 01 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00";

// kickcat, frame 3001: four FPWR of sync managers and FMMUs, to be sent.
inline constexpr std::string_view kSyncManagersAndFmmus =
    "FF FF FF FF FF FF CA DE CA DE DE FF 88 A4 60 10 05 39 E9 03 18 08 08 80 00 00 00 14 FC 00 20 00 "
    "01 00 00 00 05 3A E9 03 10 06 10 80 00 00 00 00 00 00 FC 00 00 07 00 14 00 01 01 00 00 00 00 00 "
    "05 3B E9 03 10 08 08 80 00 00 00 11 3C 00 64 00 01 00 00 00 05 3C E9 03 00 06 10 00 00 00 00 00 "
    "00 00 3C 00 00 07 00 11 00 02 01 00 00 00 00 00";

// kickcat, frame 3002: its reply.
inline constexpr std::string_view kSyncManagersAndFmmusReply =
    "FF FF FF FF FF FF CA DE CA DE DE FF 88 A4 60 10 05 39 E9 03 18 08 08 80 00 00 00 14 FC 00 20 00 "
    "01 00 01 00 05 3A E9 03 10 06 10 80 00 00 00 00 00 00 FC 00 00 07 00 14 00 01 01 00 00 00 01 00 "
    "05 3B E9 03 10 08 08 80 00 00 00 11 3C 00 64 00 01 00 01 00 05 3C E9 03 00 06 10 00 00 00 00 00 "
    "00 00 3C 00 00 07 00 11 00 02 01 00 00 00 01 00";

// kickcat, frame 3008: LRW of inputs over outputs, the reply.
inline constexpr std::string_view kProcessDataReply =
    "FF FF FF FF FF FF CA DE CA DE DE FF 88 A4 08 11 0C 3E 00 00 00 00 FC 00 00 00 10 00 00 00 00 00 "
    "00 00 00 00 E0 2E 06 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 01 01 FF 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 FF 1E 00 00 FF 1E 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 "
    "00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 03 00";

// ethercrab, frame 2: BRD of the type, from three devices.
inline constexpr std::string_view kThreeDevicesReply =
    "FF FF FF FF FF FF 12 10 10 10 10 10 88 A4 0D 10 07 00 03 00 00 00 01 00 00 00 11 03 00";

// ethercrab, frame 350: FRMW of the system time, from three devices.
inline constexpr std::string_view kClockReply =
    "FF FF FF FF FF FF 12 10 10 10 10 10 88 A4 14 10 0E AE 00 10 10 09 08 00 00 00 9A DC 30 CD 29 03 "
    "00 00 03 00";

// libethercat, frame 80: FPRD of SII data; the frame header says 32 bytes where 16 are.
inline constexpr std::string_view kWrongLengthReply =
    "FF FF FF FF FF FF 02 30 64 0F 83 35 88 A4 20 10 04 27 E8 03 08 05 04 00 00 00 E1 AD EC 00 01 00";

// ---- Mails: header and what it promises, out of 128 bytes of mailbox memory

// soem2, frame 259: upload of 1018:01.
inline constexpr std::string_view kUploadVendorRequest = "0A 00 00 00 00 13 00 20 40 18 10 01 00 00 00 00";

// soem2, frame 272: 4 bytes, expedited.
inline constexpr std::string_view kUploadVendorResponse = "0A 00 00 00 00 13 00 30 43 18 10 01 E1 AD EC 00";

// soem2, frame 288: 1008:00, 7 bytes, not expedited.
inline constexpr std::string_view kUploadNameResponse =
    "11 00 00 00 00 23 00 30 41 08 10 00 07 00 00 00 4D 65 63 61 35 30 30";

// soem2, frame 306: 1C12:00, 1 byte, expedited; SOES leaves old bytes behind it.
inline constexpr std::string_view kUploadCountResponse = "0A 00 00 00 00 33 00 30 4F 12 1C 00 09 AD EC 00";

// kickcat, frame 756: 1C12:01, 2 bytes, expedited.
inline constexpr std::string_view kUploadEntryResponse = "0A 00 00 00 00 33 00 30 4B 12 1C 01 00 16 00 00";

// soem2, frame 344: abort as a response.
inline constexpr std::string_view kNoObject = "0A 00 00 00 00 53 00 20 80 FF 5F 00 00 00 02 06";

// soem2, frame 360: abort as a request, which the standard has.
inline constexpr std::string_view kNoSubindex = "0A 00 00 00 00 63 00 20 80 18 10 09 11 00 09 06";

// soem2, frame 363: 10F1:02 = 7, 2 bytes, expedited.
inline constexpr std::string_view kDownloadRequest = "0A 00 00 00 00 73 00 20 2B F1 10 02 07 00 00 00";

// soem2, frame 380: done.
inline constexpr std::string_view kDownloadResponse = "0A 00 00 00 00 73 00 30 60 F1 10 02 00 00 00 00";

// soem2, frame 398: abort of a download.
inline constexpr std::string_view kReadOnly = "0A 00 00 00 00 13 00 20 80 18 10 01 02 00 01 06";

// soem2, frame 401: upload of the whole 1C12.
inline constexpr std::string_view kCompleteRequest = "0A 00 00 00 00 23 00 20 50 12 1C 00 00 00 00 00";

// soem2, frame 416: 20 bytes.
inline constexpr std::string_view kCompleteResponse =
    "1E 00 00 00 00 23 00 30 51 12 1C 00 14 00 00 00 09 00 00 16 01 16 02 16 10 16 11 16 20 16 21 16 "
    "22 16 23 16";

// soem2, frame 432: 2F00:00, first 112 of 512 bytes.
inline constexpr std::string_view kLongUpload =
    "7A 00 00 00 00 33 00 30 41 00 2F 00 00 02 00 00 00 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 0F "
    "10 11 12 13 14 15 16 17 18 19 1A 1B 1C 1D 1E 1F 20 21 22 23 24 25 26 27 28 29 2A 2B 2C 2D 2E 2F "
    "30 31 32 33 34 35 36 37 38 39 3A 3B 3C 3D 3E 3F 40 41 42 43 44 45 46 47 48 49 4A 4B 4C 4D 4E 4F "
    "50 51 52 53 54 55 56 57 58 59 5A 5B 5C 5D 5E 5F 60 61 62 63 64 65 66 67 68 69 6A 6B 6C 6D 6E 6F";

// soem2, frame 433: the next, toggle 0.
inline constexpr std::string_view kLongUploadSegmentRequest = "0A 00 00 00 00 43 00 20 60 00 2F 00 00 00 00 00";

// soem2, frame 448: 119 bytes.
inline constexpr std::string_view kLongUploadSegment =
    "7A 00 00 00 00 43 00 30 00 70 71 72 73 74 75 76 77 78 79 7A 7B 7C 7D 7E 7F 80 81 82 83 84 85 86 "
    "87 88 89 8A 8B 8C 8D 8E 8F 90 91 92 93 94 95 96 97 98 99 9A 9B 9C 9D 9E 9F A0 A1 A2 A3 A4 A5 A6 "
    "A7 A8 A9 AA AB AC AD AE AF B0 B1 B2 B3 B4 B5 B6 B7 B8 B9 BA BB BC BD BE BF C0 C1 C2 C3 C4 C5 C6 "
    "C7 C8 C9 CA CB CC CD CE CF D0 D1 D2 D3 D4 D5 D6 D7 D8 D9 DA DB DC DD DE DF E0 E1 E2 E3 E4 E5 E6";

// soem2, frame 449: the next, toggle 1.
inline constexpr std::string_view kLongUploadSegmentRequest1 = "0A 00 00 00 00 53 00 20 70 00 2F 00 00 00 00 00";

// soem2, frame 498: 43 bytes, the last.
inline constexpr std::string_view kLongUploadLast =
    "2E 00 00 00 00 73 00 30 11 D5 D6 D7 D8 D9 DA DB DC DD DE DF E0 E1 E2 E3 E4 E5 E6 E7 E8 E9 EA EB "
    "EC ED EE EF F0 F1 F2 F3 F4 F5 F6 F7 F8 F9 FA FB FC FD FE FF";

// soem2, frame 501: 2F00:00, first 112 of 512 bytes.
inline constexpr std::string_view kLongDownload =
    "7A 00 00 00 00 13 00 20 21 00 2F 00 00 02 00 00 00 03 06 09 0C 0F 12 15 18 1B 1E 21 24 27 2A 2D "
    "30 33 36 39 3C 3F 42 45 48 4B 4E 51 54 57 5A 5D 60 63 66 69 6C 6F 72 75 78 7B 7E 81 84 87 8A 8D "
    "90 93 96 99 9C 9F A2 A5 A8 AB AE B1 B4 B7 BA BD C0 C3 C6 C9 CC CF D2 D5 D8 DB DE E1 E4 E7 EA ED "
    "F0 F3 F6 F9 FC FF 02 05 08 0B 0E 11 14 17 1A 1D 20 23 26 29 2C 2F 32 35 38 3B 3E 41 44 47 4A 4D";

// kickcat, frame 503: the same, no data in the first mail.
inline constexpr std::string_view kLongDownloadWithoutData = "0A 00 00 00 00 73 00 20 21 00 2F 00 00 02 00 00";

// soem2, frame 517: 119 bytes.
inline constexpr std::string_view kLongDownloadSegment =
    "7A 00 00 00 00 23 00 20 00 50 53 56 59 5C 5F 62 65 68 6B 6E 71 74 77 7A 7D 80 83 86 89 8C 8F 92 "
    "95 98 9B 9E A1 A4 A7 AA AD B0 B3 B6 B9 BC BF C2 C5 C8 CB CE D1 D4 D7 DA DD E0 E3 E6 E9 EC EF F2 "
    "F5 F8 FB FE 01 04 07 0A 0D 10 13 16 19 1C 1F 22 25 28 2B 2E 31 34 37 3A 3D 40 43 46 49 4C 4F 52 "
    "55 58 5B 5E 61 64 67 6A 6D 70 73 76 79 7C 7F 82 85 88 8B 8E 91 94 97 9A 9D A0 A3 A6 A9 AC AF B2";

// soem2, frame 530: toggle 0; SOES leaves old bytes behind it.
inline constexpr std::string_view kLongDownloadSegmentResponse = "0A 00 00 00 00 23 00 30 20 00 00 00 D8 D9 DA DB";

// soem2, frame 546: toggle 1.
inline constexpr std::string_view kLongDownloadSegmentResponse1 = "0A 00 00 00 00 33 00 30 30 00 00 00 00 00 00 00";

// soem2, frame 563: 43 bytes, the last.
inline constexpr std::string_view kLongDownloadLast =
    "2E 00 00 00 00 53 00 20 11 7F 82 85 88 8B 8E 91 94 97 9A 9D A0 A3 A6 A9 AC AF B2 B5 B8 BB BE C1 "
    "C4 C7 CA CD D0 D3 D6 D9 DC DF E2 E5 E8 EB EE F1 F4 F7 FA FD";

// soem2, frame 1026: the whole 1A11, first 112 of 122 bytes.
inline constexpr std::string_view kSafetyMapping =
    "7A 00 00 00 00 33 00 30 51 11 1A 00 7A 00 00 00 1E 00 01 02 65 60 01 00 00 00 01 04 65 60 01 00 "
    "00 00 01 00 00 00 01 00 00 00 01 00 00 00 01 08 65 60 01 00 00 00 01 00 00 00 01 0B 65 60 01 00 "
    "00 00 14 00 00 00 01 0D 65 60 01 00 00 00 01 0F 65 60 01 00 00 00 01 00 00 00 01 00 00 00 01 00 "
    "00 00 01 13 65 60 01 00 00 00 01 00 00 00 01 16 65 60 01 00 00 00 14 00 00 00 08 00 00 00 01 18";

// soem2, frame 1042: the other 10.
inline constexpr std::string_view kSafetyMappingLast = "0D 00 00 00 00 43 00 30 01 65 60 01 19 65 60 16 00 00 00";

inline constexpr std::string_view kFrames[] = {
    kAcknowledgeAndInit,        kAcknowledgeAndInitReply, kMailboxStatusReply, kSyncManagersAndFmmus,
    kSyncManagersAndFmmusReply, kProcessDataReply,        kThreeDevicesReply,  kClockReply,
    kWrongLengthReply};
inline constexpr std::string_view kMails[] = {kUploadVendorRequest,
                                              kUploadVendorResponse,
                                              kUploadNameResponse,
                                              kUploadCountResponse,
                                              kUploadEntryResponse,
                                              kNoObject,
                                              kNoSubindex,
                                              kDownloadRequest,
                                              kDownloadResponse,
                                              kReadOnly,
                                              kCompleteRequest,
                                              kCompleteResponse,
                                              kLongUpload,
                                              kLongUploadSegmentRequest,
                                              kLongUploadSegment,
                                              kLongUploadSegmentRequest1,
                                              kLongUploadLast,
                                              kLongDownload,
                                              kLongDownloadWithoutData,
                                              kLongDownloadSegment,
                                              kLongDownloadSegmentResponse,
                                              kLongDownloadSegmentResponse1,
                                              kLongDownloadLast,
                                              kSafetyMapping,
                                              kSafetyMappingLast};

}  // namespace meca::ethercat::golden
