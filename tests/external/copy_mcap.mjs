// Copies an MCAP file by @mcap/core in the ways that recorders differ in. usage: copy_mcap.mjs FILE.mcap OUT_PREFIX
import fs from "node:fs";
import { McapStreamReader, McapWriter } from "@mcap/core";
import { decompress as unzstd } from "fzstd";
import lz4 from "lz4js";

const [source, prefix] = process.argv.slice(2);
const decompressHandlers = { zstd: (bytes, size) => unzstd(bytes, new Uint8Array(Number(size))) };
const bare = { useStatistics: false, useSummaryOffsets: false, useChunkIndex: false, useMessageIndex: false, repeatSchemas: false, repeatChannels: false };
const ways = {
  chunks: { chunkSize: 500 },
  lz4: { chunkSize: 500, compressChunk: (bytes) => ({ compression: "lz4", compressedData: lz4.compress(bytes) }) },
  no_summary: { chunkSize: 500, ...bare },
  no_chunks: { useChunks: false },
  nothing: { useChunks: false, ...bare },
};

for (const [name, options] of Object.entries(ways)) {
  const written = [];
  let position = 0n;
  const writable = {
    write: async (bytes) => {
      written.push(Buffer.from(bytes));
      position += BigInt(bytes.length);
    },
    position: () => position,
  };
  const writer = new McapWriter({ writable, ...options });
  await writer.start({ profile: "ros2", library: "copy" });
  const reader = new McapStreamReader({ decompressHandlers });
  reader.append(fs.readFileSync(source));
  const schemas = new Map(), channels = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema" && !schemas.has(record.id)) schemas.set(record.id, await writer.registerSchema(record));
    if (record.type === "Channel" && !channels.has(record.id))
      channels.set(record.id, await writer.registerChannel({ ...record, schemaId: schemas.get(record.schemaId) }));
    if (record.type === "Message") await writer.addMessage({ ...record, channelId: channels.get(record.channelId) });
  }
  await writer.end();
  fs.writeFileSync(`${prefix}_${name}.mcap`, Buffer.concat(written));
}
