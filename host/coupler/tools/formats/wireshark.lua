-- Requests and their replies ------------------------------------------------------------------------------------------

local waiting, answers = {}, {}  -- by connection and transaction id; by place in the capture

local function connection(client, client_port, server, server_port)
  return tostring(client) .. ":" .. client_port .. ">" .. tostring(server) .. ":" .. server_port
end

local function dissect_one(tvb, pinfo, tree)
  -- A capture may end each packet early. Wireshark's dissector then gives up in a way that does not come back through Lua.
  if tvb:len() < tvb:reported_len() then
    Dissector.get("data"):call(tvb, pinfo, tree)
    return tvb:len()
  end
  Dissector.get("mbtcp"):call(tvb, pinfo, tree)
  if tvb:len() < 9 then return tvb:len() end
  local unit = tvb(6, 1):uint()
  if unit ~= map.unit and unit ~= 0 and unit ~= 255 then return tvb:len() end
  local transaction = tvb(0, 2):uint()
  if pinfo.dst_port == pinfo.match then
    local request = request_of(tvb)
    if request.code >= wait_code then request = time_request_of(tvb) end
    if not request.read and not request.write and not request.show then return tvb:len() end
    local key = connection(pinfo.src, pinfo.src_port, pinfo.dst, pinfo.dst_port) .. "#" .. transaction
    if not pinfo.visited then waiting[key] = request end
    local show = request.show and show_time_request or show_request
    show(tvb, pinfo, tree, request)
    return tvb:len()
  end
  local key = connection(pinfo.dst, pinfo.dst_port, pinfo.src, pinfo.src_port) .. "#" .. transaction
  local place = pinfo.number .. "/" .. key .. "/" .. tvb:offset()
  if not pinfo.visited then
    answers[place] = waiting[key]
    waiting[key] = nil
  end
  local request = answers[place]
  if request and tvb(7, 1):uint() % 128 == request.code then
    local show = request.show and show_time_reply or show_reply
    show(tvb, pinfo, tree, request)
  end
  return tvb:len()
end

local function length_of(tvb, _, offset) return 6 + tvb(offset + 4, 2):uint() end

function proto.dissector(tvb, pinfo, tree)
  dissect_tcp_pdus(tvb, tree, 6, length_of, dissect_one)
  return tvb:len()
end

local registered
local ports = DissectorTable.get("tcp.port")
ports:add_for_decode_as(proto)
local function register()
  if registered == proto.prefs.port then return end
  if registered then ports:remove(registered, proto) end
  registered = proto.prefs.port
  ports:add(registered, proto)
end

function proto.prefs_changed() register() end

function proto.init()
  waiting, answers = {}, {}
  register()
end
