// Bags and MCAP files as readers of others see them, brought to one form: names of members in ROS 2's spelling, times as
// BigInt nanoseconds, typed arrays as plain ones (bytes as Buffer), no seq.
import fs from "node:fs/promises";
import rosbag from "@foxglove/rosbag";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress as unzstd } from "fzstd";
import lz4 from "lz4js";

const { Bag } = rosbag;
const ns = (time) => BigInt(time.sec) * 1000000000n + BigInt(time.nsec ?? time.nanosec);

function plain(value) {
  if (value instanceof Uint8Array) return Buffer.from(value);
  if (ArrayBuffer.isView(value) || Array.isArray(value)) return Array.from(value, plain);
  if (value === null || typeof value !== "object") return value;
  const keys = Object.keys(value);
  if (keys.length === 2 && keys.includes("sec")) return ns(value);
  const members = keys.filter((key) => key !== "seq").map((key) => [key.length === 1 ? key.toLowerCase() : key, plain(value[key])]);
  return Object.fromEntries(members);
}

/// A list of {topic, type, recorded, latched, message}, in the reader's order.
export async function readBag(path) {
  const lz4Frame = (bytes, size) => {
    const out = lz4.decompress(bytes, size);
    if (out.length !== size) throw new Error(`LZ4 chunk of ${out.length} bytes, ${size} announced`);
    return out;
  };
  const bytes = await fs.readFile(path);
  const file = { size: () => bytes.length, read: async (offset, size) => bytes.subarray(offset, offset + size) };
  const bag = new Bag(file, { decompress: { lz4: lz4Frame } });
  await bag.open();
  const messages = [];
  for await (const event of bag.messageIterator()) {
    const connection = bag.connections.get(event.connectionId);
    messages.push({
      topic: event.topic,
      type: connection.type,
      recorded: ns(event.timestamp),
      latched: connection.latching === true,
      message: plain(event.message),
    });
  }
  return messages;
}

const decompressHandlers = { zstd: (bytes, size) => unzstd(bytes, new Uint8Array(Number(size))) };

/// The same of an MCAP file. Read twice: by its index, and from front to back with every checksum validated.
export async function readMcap(path) {
  const bytes = await fs.readFile(path);
  const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers, includeChunks: true });
  stream.append(bytes);
  const kinds = {};
  for (let record; (record = stream.nextRecord()); ) kinds[record.type] = (kinds[record.type] ?? 0) + 1;
  if (!stream.done()) throw new Error("the stream reader is not at the end of the file");

  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const decoders = new Map();
  const messages = [];
  for await (const record of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(record.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (schema.encoding !== "ros2msg" || channel.messageEncoding !== "cdr")
      throw new Error(`${channel.topic}: ${schema.encoding}, ${channel.messageEncoding}`);
    if (!decoders.has(schema.id))
      decoders.set(schema.id, new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true })));
    messages.push({
      topic: channel.topic,
      type: schema.name.replace("/msg/", "/"),
      recorded: record.logTime,
      latched: /durability: 1\b/.test(channel.metadata.get("offered_qos_profiles") ?? ""),
      message: plain(decoders.get(schema.id).readMessage(record.data)),
    });
  }
  const statistics = reader.statistics;
  for (const [what, indexed, streamed] of [
    ["messages", messages.length, kinds.Message],
    ["messages of the statistics", Number(statistics.messageCount), kinds.Message],
    ["chunks", reader.chunkIndexes.length, kinds.Chunk],
    ["chunks of the statistics", statistics.chunkCount, kinds.Chunk],
    ["channels of the statistics", statistics.channelCount, reader.channelsById.size],
  ])
    if (indexed !== (streamed ?? 0)) throw new Error(`${what}: ${indexed} by the index, ${streamed} by the stream`);
  if (reader.header.profile !== "ros2") throw new Error(`profile "${reader.header.profile}"`);
  return messages;
}
