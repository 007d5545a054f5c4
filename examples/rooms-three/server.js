import express from 'express';
import { attachRooms } from 'threepoint-rooms/server';

const app = express().use(express.static('dist'));
attachRooms(app.listen(process.env.PORT ?? 8080));
