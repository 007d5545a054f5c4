import express from 'express';
import easyrtc from 'open-easyrtc';
import { Server } from 'socket.io';

const app = express().use(express.static('dist'));
const http = app.listen(process.env.PORT ?? 8080);
easyrtc.setOption('logLevel', 'warning');
easyrtc.listen(app, new Server(http));
